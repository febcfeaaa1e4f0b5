"""Calibration files as the field writes them: figures/field_calibrations, figures/field_calibrations.json.

Every file is read here by the program that defines it, or by its published rules, and projects points: cv2.FileStorage with
cv2.projectPoints, cv2.fisheye and cv2.omnidir; pycolmap from cameras.bin; PyYAML for ROS (camera_calibration_parsers assumes plumb_bob
where a file states no model), Kalibr (aslam_cv's CameraParameters knows these names only) and EuRoC. camodocal writes with
cv::FileStorage. Its SCARAMUZZA is the direct polynomial: pixels see directions.

The files of figures/rig, which the binary writes, must be accepted by the same rules. Pixels are raster coordinates: those of OpenCV
plus 0.5, those of COLMAP as they are. Versions: requirements.txt. Run anywhere:
    python tests/oracles/calibrations.py
"""

import json
import pathlib

import cv2
import numpy as np
import pycolmap
import yaml

ROOT = pathlib.Path(__file__).parent / "figures"
FILES = ROOT / "field_calibrations"
RIG = ROOT / "rig" / "calibration"
ZERO = np.zeros(3)
K = np.array([[402.5, 0.0, 318.3], [0.0, 401.9, 241.7], [0.0, 0.0, 1.0]])
RIGHT = np.array([[411.25, 0.0, 322.1], [0.0, 410.5, 238.4], [0.0, 0.0, 1.0]])
SKEWED = np.array([[402.5, -0.31, 318.3], [0.0, 401.9, 241.7], [0.0, 0.0, 1.0]])
FOUR = [-0.21, 0.07, 0.0006, -0.0004]
FIVE = FOUR + [-0.011]
EIGHT = [0.4, -0.25, 0.0009, 0.0002, 0.03, 0.72, -0.19, 0.01]
TWELVE = [-0.2, 0.05, 0.0011, -0.0008, 0.01, 0.02, -0.005, 0.001, 0.002, -0.001, 0.0015, 0.0004]
FOURTEEN = TWELVE + [0.06, -0.11]
FISHEYE = [-0.02, 0.006, -0.004, 0.001]
XI, OMNI = 0.8, [-0.1, 0.02, 0.0007, -0.0003]
SIZE = [640, 480]
# Kalibr, aslam_cv_cameras: ParametersBase.py.
KALIBR = {"pinhole": 4, "omni": 5, "eucm": 6, "ds": 6}
KALIBR_DISTORTION = {"radtan": 4, "equidistant": 4, "fov": 1, "none": 0}


def ahead(rng, count=8, tangent=0.7):
    """Points before a camera, in its frame."""
    z = rng.uniform(0.5, 20.0, count)
    return np.column_stack([rng.uniform(-tangent, tangent, count) * z, rng.uniform(-0.75, 0.75, count) * tangent * z, z])


def perspective(points, k, d):
    return cv2.projectPoints(points, ZERO, ZERO, k, np.array(d, float) if len(d) else None)[0].reshape(-1, 2)


def fisheye(points, k, d):
    """u = fx (x + alpha y) + cx, where the camera matrix holds alpha fx."""
    alpha, k = k[0, 1] / k[0, 0], np.array([[k[0, 0], 0.0, k[0, 2]], *k[1:]])
    pixels = cv2.fisheye.projectPoints(points[:, None, :], ZERO, ZERO, k, np.array(d, float), alpha=alpha)[0]
    return pixels.reshape(-1, 2)


def omnidirectional(points, k, xi, d):
    return cv2.omnidir.projectPoints(points[:, None, :], ZERO, ZERO, k, xi, np.array([d], float))[0].reshape(-1, 2)


class Table:
    """Points that the camera of a file sees, and where."""

    def __init__(self):
        self.rng, self.entries = np.random.default_rng(20261129), []

    def add(self, file, name, project, *, camera=None, size=SIZE, offset=0.5, tangent=0.7):
        points = ahead(self.rng, tangent=tangent)
        self.entries.append({"file": file, "format": name, "camera": camera, "size_px": size, "points_m": points.tolist(),
                             "pixels": (project(points) + offset).tolist()})


def storage(name, entries):
    """A file of cv2.FileStorage: numbers, texts, matrices, and maps of them."""
    file = cv2.FileStorage(str(FILES / name), cv2.FILE_STORAGE_WRITE)

    def put(entries):
        for key, value in entries.items():
            if isinstance(value, dict):
                file.startWriteStruct(key, cv2.FileNode_MAP)
                put(value)
                file.endWriteStruct()
            else:
                file.write(key, value)

    put(entries)
    file.release()


def loaded(name):
    """Values of a file by their key, as OpenCV reads them."""
    file = cv2.FileStorage(str(FILES / name), cv2.FILE_STORAGE_READ)

    def value(node):
        if node.isMap() and "data" not in node.keys():
            return {key: value(node.getNode(key)) for key in node.keys()}
        if node.isMap():
            return node.mat()
        return node.string() if node.isString() else node.real()

    return {key: value(file.getNode(key)) for key in file.root().keys()}


def column(values):
    return np.array([values], float).T


def opencv(table):
    size = {"image_width": SIZE[0], "image_height": SIZE[1]}
    old = {"image_Width": SIZE[0], "image_Height": SIZE[1]}
    for suffix in ("yml", "xml", "json"):
        name = f"out_camera_data.{suffix}"
        storage(name, {"calibration_time": "Sun 29 Nov 2026", "nframes": 12, **size, "board_width": 9, "flags": 4, "camera_matrix": K,
                       "distortion_coefficients": column(FIVE), "avg_reprojection_error": 0.25})
        read = loaded(name)
        table.add(name, "opencv", lambda p: perspective(p, read["camera_matrix"], read["distortion_coefficients"]))
        name = f"old_sample.{suffix}"
        storage(name, {**old, "Camera_Matrix": K, "Distortion_Coefficients": column(FIVE)})
        read = loaded(name)
        table.add(name, "opencv", lambda p: perspective(p, read["Camera_Matrix"], read["Distortion_Coefficients"]))
    for count, d in (("4", FOUR), ("8", EIGHT), ("12", TWELVE), ("14", FOURTEEN)):
        name = f"coefficients_{count}.xml"
        storage(name, {**size, "cameraMatrix": K, "distCoeffs": np.array([d])})
        read = loaded(name)
        table.add(name, "opencv", lambda p: perspective(p, read["cameraMatrix"], read["distCoeffs"]))
    storage("dist_coeffs.yaml", {"K": K, "dist_coeffs": column(FIVE), "width": 640.0, "height": 480.0})
    table.add("dist_coeffs.yaml", "opencv", lambda p: perspective(p, K, FIVE))
    # OpenCV's stereo sample: intrinsics.yml states no size.
    storage("intrinsics.yml", {"M1": K, "D1": np.array([FOURTEEN]), "M2": RIGHT, "D2": np.array([FIVE])})
    read = loaded("intrinsics.yml")
    for camera, m, d in (("left", "M1", "D1"), ("M2", "M2", "D2"), ("right", "M2", "D2")):
        table.add("intrinsics.yml", "opencv", lambda p: perspective(p, read[m], read[d]), camera=camera, size=None)
    storage("stereo.xml", {"imageSize": np.array([[640, 480]]), "cameraMatrixL": K, "distCoeffsL": np.array([FIVE]), "cameraMatrixR": RIGHT,
                           "distCoeffsR": np.array([FOUR])})
    table.add("stereo.xml", "opencv", lambda p: perspective(p, K, FIVE), camera="left")
    table.add("stereo.xml", "opencv", lambda p: perspective(p, RIGHT, FOUR), camera="cameraMatrixR")
    storage("maps.json", {"front": {**size, "camera_matrix": K, "dist_coeff": np.array([FIVE])},
                          "rear": {"width": 640, "height": 480, "model": "fisheye", "K": RIGHT, "D": column(FISHEYE)}})
    read = loaded("maps.json")
    table.add("maps.json", "opencv", lambda p: perspective(p, read["front"]["camera_matrix"], read["front"]["dist_coeff"]), camera="front")
    table.add("maps.json", "opencv", lambda p: fisheye(p, read["rear"]["K"], read["rear"]["D"]), camera="rear", tangent=3.0)
    storage("fisheye.xml", {**size, "fisheye_model": 1, "camera_matrix": SKEWED, "distortion_coefficients": column(FISHEYE)})
    read = loaded("fisheye.xml")
    table.add("fisheye.xml", "opencv", lambda p: fisheye(p, read["camera_matrix"], read["distortion_coefficients"]), tangent=3.0)
    storage("omnidir.xml", {**size, "camera_matrix": SKEWED, "D": np.array([OMNI]), "xi": np.array([[XI]])})
    read = loaded("omnidir.xml")
    table.add("omnidir.xml", "opencv", lambda p: omnidirectional(p, read["camera_matrix"], read["xi"].item(), read["D"][0]), tangent=1.5)
    # ORB-SLAM's settings, which cv::FileStorage reads.
    for name, first, model, k in (("orb_slam_pinhole.yaml", "Camera1", "PinHole", ("k1", "k2", "p1", "p2", "k3")),
                                  ("orb_slam_fisheye.yaml", "Camera", "KannalaBrandt8", ("k1", "k2", "k3", "k4"))):
        d = FIVE if model == "PinHole" else FISHEYE
        lines = ["%YAML:1.0", "", f'Camera.type: "{model}"', *(f"{first}.{key}: {value}" for key, value in
                 zip(("fx", "fy", "cx", "cy", *k), (K[0, 0], K[1, 1], K[0, 2], K[1, 2], *d))),
                 "Camera.width: 640", "Camera.height: 480", "Camera.fps: 20", "ORBextractor.nFeatures: 1000"]
        (FILES / name).write_text("\n".join(lines) + "\n")
        read = loaded(name)
        values = [read[f"{first}.{key}"] for key in k]
        matrix = np.array([[read[f"{first}.fx"], 0.0, read[f"{first}.cx"]], [0.0, read[f"{first}.fy"], read[f"{first}.cy"]], [0.0, 0.0, 1.0]])
        project = perspective if model == "PinHole" else fisheye
        table.add(name, "opencv", lambda p: project(p, matrix, values), tangent=0.7 if model == "PinHole" else 3.0)


def ros_seen(points, model, k, d):
    """image_geometry: OpenCV's functions with D."""
    k = np.array(k, float).reshape(3, 3)
    if model in ("equidistant", "fisheye"):
        return fisheye(points, k, d[:4])
    assert model in ("plumb_bob", "rational_polynomial", "thin_prism"), model
    return perspective(points, k, d)


def ros_file(name):
    """camera_calibration_parsers' rules for YAML."""
    read = yaml.safe_load((FILES / name).read_text() if isinstance(name, str) else name.read_text())
    shape = read["distortion_coefficients"]
    d = shape["data"]
    assert len(d) == shape["rows"] * shape["cols"] and len(read["camera_matrix"]["data"]) == 9 and len(read["projection_matrix"]["data"]) == 12
    return read.get("distortion_model", read.get("camera_model", "plumb_bob")), read["camera_matrix"]["data"], d


def ros(table):
    identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    projection = [402.5, 0.0, 318.3, 0.0, 0.0, 401.9, 241.7, 0.0, 0.0, 0.0, 1.0, 0.0]

    def matrix(key, rows, columns, data):
        return f"{key}:\n  rows: {rows}\n  cols: {columns}\n  data: {list(data)}\n"

    cases = [("plumb_bob", "distortion_model: plumb_bob\n", K, FIVE), ("rational_polynomial", "distortion_model: rational_polynomial\n", K, EIGHT),
             ("thin_prism", "distortion_model: thin_prism\n", K, TWELVE), ("tilted", "distortion_model: rational_polynomial\n", K, FOURTEEN),
             ("equidistant_skew", "distortion_model: equidistant\n", SKEWED, FISHEYE), ("fisheye", "distortion_model: fisheye\n", K, FISHEYE),
             ("camera_model", "camera_model: plumb_bob\n", K, FOUR), ("no_model", "", K, FIVE),
             ("both_models", "camera_model: pinhole\ndistortion_model: equidistant\n", K, FISHEYE)]
    for case, model, k, d in cases:
        name = f"ros_{case}.yaml"
        (FILES / name).write_text("image_width: 640\nimage_height: 480\ncamera_name: test\n" + matrix("camera_matrix", 3, 3, k.ravel().tolist()) + model +
                                  matrix("distortion_coefficients", 1, len(d), d) + matrix("rectification_matrix", 3, 3, identity) +
                                  matrix("projection_matrix", 3, 4, projection))
        read = ros_file(name)
        table.add(name, "ros", lambda p: ros_seen(p, *read), tangent=3.0 if read[0] in ("equidistant", "fisheye") else 0.7)
    # As genpy prints a message of ROS 1.
    one = (f"header: \n  seq: 12\n  stamp: \n    secs: 100\n    nsecs:      5000\n  frame_id: \"front\"\nheight: 480\nwidth: 640\n"
           f"distortion_model: \"plumb_bob\"\nD: {FIVE}\nK: {K.ravel().tolist()}\nR: {identity}\nP: {projection}\nbinning_x: 0\nbinning_y: 0\nroi: \n"
           "  x_offset: 0\n  y_offset: 0\n  height: 0\n  width: 0\n  do_rectify: False\n---\n")
    (FILES / "ros1_echo.yaml").write_text(one)
    (FILES / "ros1_echo_twice.txt").write_text(one + one)
    # As ros2 topic echo prints one: yaml.dump of the message.
    message = {"header": {"stamp": {"sec": 100, "nanosec": 5000}, "frame_id": "front"}, "height": 480, "width": 640, "distortion_model": "equidistant",
               "d": FISHEYE, "k": SKEWED.ravel().tolist(), "r": identity, "p": projection, "binning_x": 0, "binning_y": 0,
               "roi": {"x_offset": 0, "y_offset": 0, "height": 0, "width": 0, "do_rectify": False}}
    (FILES / "ros2_echo.yaml").write_text(yaml.dump(message, sort_keys=False, default_flow_style=False) + "---\n")
    for name, key in (("ros1_echo.yaml", "K"), ("ros1_echo_twice.txt", "K"), ("ros2_echo.yaml", "k")):
        read = next(yaml.safe_load_all((FILES / name).read_text()))
        d = read["D" if key == "K" else "d"]
        table.add(name, "ros", lambda p: ros_seen(p, read["distortion_model"], read[key], d), camera="front", tangent=0.7 if key == "K" else 3.0)
    rows = "\n".join(" ".join(f"{x:.6f}" for x in row) for row in K)
    (FILES / "ost.txt").write_text(f"# oST version 5.0 parameters\n\n\n[image]\n\nwidth\n640\n\nheight\n480\n\n[narrow_stereo]\n\ncamera matrix\n{rows}\n\ndistortion\n" +
                                   " ".join(f"{x:.6f}" for x in FIVE) + f"\n\nrectification\n{rows}\n\nprojection\n{rows}\n")
    table.add("ost.txt", "ros", lambda p: perspective(p, K, FIVE), camera="narrow_stereo")


def kalibr_camera(camera):
    """Refuses what CameraParameters refuses."""
    focal = camera["intrinsics"][-4:]
    assert len(camera["intrinsics"]) == KALIBR[camera["camera_model"]] and all(isinstance(x, float) for x in focal), camera
    assert len(camera["distortion_coeffs"]) == KALIBR_DISTORTION[camera["distortion_model"]], camera
    assert all(isinstance(x, int) for x in camera["resolution"]) and len(camera["resolution"]) == 2 and isinstance(camera["rostopic"], str), camera
    return camera


def kalibr_seen(points, camera):
    *own, fu, fv, pu, pv = camera["intrinsics"]
    k, d = np.array([[fu, 0.0, pu], [0.0, fv, pv], [0.0, 0.0, 1.0]]), camera["distortion_coeffs"]
    match camera["camera_model"], camera["distortion_model"]:
        case "pinhole", "radtan" | "none":
            return perspective(points, k, d)
        case "pinhole", "equidistant":
            return fisheye(points, k, d)
        case "omni", "radtan":
            return omnidirectional(points, k, own[0], d)


def kalibr(table):
    base = {"resolution": SIZE, "cam_overlaps": [1]}
    focal = [402.5, 401.9, 318.3, 241.7]
    transform = [[1.0, 0.0, 0.0, -0.1], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
    chain = {
        "cam0": {**base, "camera_model": "pinhole", "intrinsics": focal, "distortion_model": "equidistant", "distortion_coeffs": FISHEYE, "rostopic": "/cam0/image_raw"},
        "cam1": {**base, "camera_model": "pinhole", "intrinsics": focal, "distortion_model": "radtan", "distortion_coeffs": FOUR, "rostopic": "/cam1/image_raw",
                 "T_cn_cnm1": transform},
        "cam2": {**base, "camera_model": "omni", "intrinsics": [XI, *focal], "distortion_model": "radtan", "distortion_coeffs": OMNI, "rostopic": "/cam2/image_raw",
                 "T_cn_cnm1": transform, "timeshift_cam_imu": 0.001},
        "cam3": {**base, "camera_model": "pinhole", "intrinsics": focal, "distortion_model": "none", "distortion_coeffs": [], "rostopic": "/cam3/image_raw",
                 "T_cn_cnm1": transform},
    }
    # Kalibr's lists are its own, so its files have no aliases.
    (FILES / "camchain.yaml").write_text(yaml.dump(json.loads(json.dumps(chain))))
    for name, camera in yaml.safe_load((FILES / "camchain.yaml").read_text()).items():
        tangent = {"equidistant": 3.0}.get(camera["distortion_model"], 0.7)
        table.add("camchain.yaml", "kalibr", lambda p: kalibr_seen(p, kalibr_camera(camera)), camera=name, tangent=tangent)
    for name, model, d, seen in (("euroc_radtan.yaml", "radial-tangential", FOUR, perspective), ("euroc_equidistant.yaml", "equidistant", FISHEYE, fisheye)):
        (FILES / name).write_text("# General sensor definitions.\nsensor_type: camera\ncomment: VI-Sensor cam0 (MT9M034)\n\nT_BS:\n  cols: 4\n  rows: 4\n"
                                  "  data: [0.0, -1.0, 0.0, -0.02,\n         1.0, 0.0, 0.0, -0.06,\n         0.0, 0.0, 1.0, 0.01,\n         0.0, 0.0, 0.0, 1.0]\n\n"
                                  f"rate_hz: 20\nresolution: [640, 480]\ncamera_model: pinhole\nintrinsics: {focal} #fu, fv, cu, cv\n"
                                  f"distortion_model: {model}\ndistortion_coefficients: {d}\n")
        read = yaml.safe_load((FILES / name).read_text())
        fu, fv, cu, cv = read["intrinsics"]
        k = np.array([[fu, 0.0, cu], [0.0, fv, cv], [0.0, 0.0, 1.0]])
        table.add(name, "euroc", lambda p: seen(p, k, read["distortion_coefficients"]), tangent=3.0 if seen is fisheye else 0.7)


def camodocal(table):
    base = {"camera_name": "front", "image_width": SIZE[0], "image_height": SIZE[1]}
    plane = {"fx": K[0, 0], "fy": K[1, 1], "cx": K[0, 2], "cy": K[1, 2]}
    mei = {"gamma1": K[0, 0], "gamma2": K[1, 1], "u0": K[0, 2], "v0": K[1, 2]}
    angle = {"mu": K[0, 0], "mv": K[1, 1], "u0": K[0, 2], "v0": K[1, 2]}
    four, eight = ("k1", "k2", "p1", "p2"), ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")
    bend = dict(zip(("k2", "k3", "k4", "k5"), FISHEYE))
    cases = [("pinhole", {"model_type": "PINHOLE", **base, "distortion_parameters": dict(zip(four, FOUR)), "projection_parameters": plane}),
             ("pinhole_full", {"model_type": "PINHOLE_FULL", **base, "distortion_parameters": dict(zip(eight, EIGHT)), "projection_parameters": plane}),
             ("mei", {"model_type": "MEI", **base, "mirror_parameters": {"xi": XI}, "distortion_parameters": dict(zip(four, OMNI)), "projection_parameters": mei}),
             ("kannala_brandt", {"model_type": "KANNALA_BRANDT", **base, "projection_parameters": {**bend, **angle}}),
             ("kannala_brandt_apart", {"model_type": "kannala_brandt", **base, "distortion_parameters": bend, "projection_parameters": angle})]
    for case, entries in cases:
        name = f"camodocal_{case}.yaml"
        storage(name, entries)
        read = loaded(name)
        projection = read["projection_parameters"]
        values = [projection[key] for key in (("gamma1", "gamma2", "u0", "v0") if case == "mei" else ("mu", "mv", "u0", "v0") if "brandt" in case else tuple(plane))]
        k = np.array([[values[0], 0.0, values[2]], [0.0, values[1], values[3]], [0.0, 0.0, 1.0]])
        d = list((projection if case == "kannala_brandt" else read["distortion_parameters"]).values())[:8]
        if case == "mei":
            table.add(name, "camodocal", lambda p: omnidirectional(p, k, read["mirror_parameters"]["xi"], d), camera="front", tangent=1.5)
        elif "brandt" in case:
            table.add(name, "camodocal", lambda p: fisheye(p, k, d[:4]), camera="front", tangent=3.0)
        else:
            table.add(name, "camodocal", lambda p: perspective(p, k, d), camera="front")
    scaramuzza(table, base)


def scaramuzza(table, base):
    """liftProjective of camodocal with the affine map undone for the direction as well; stored as points on the rays of pixels."""
    poly, affine = [-218.6, 0.0, 1.95e-3, -1.6e-6, 6.9e-9], {"ac": 0.9991, "ad": 0.00031, "ae": -0.00017, "cx": 319.8, "cy": 241.25}
    inverse = {f"p{i}": 0.0 for i in range(20)}
    storage("camodocal_scaramuzza.yaml", {"model_type": "scaramuzza", **base, "poly_parameters": {f"p{i}": p for i, p in enumerate(poly)},
                                          "inv_poly_parameters": inverse, "affine_parameters": affine})
    read = loaded("camodocal_scaramuzza.yaml")
    a, p = read["affine_parameters"], [read["poly_parameters"][f"p{i}"] for i in range(5)]
    pixels = table.rng.uniform([0.0, 0.0], [639.0, 479.0], (8, 2))
    across = np.linalg.solve([[a["ac"], a["ad"]], [a["ae"], 1.0]], (pixels - [a["cx"], a["cy"]]).T).T
    rho = np.hypot(*across.T)
    z = -sum(c * rho**i for i, c in enumerate(p))
    table.entries.append({"file": "camodocal_scaramuzza.yaml", "format": "camodocal", "camera": "front", "size_px": SIZE,
                          "points_m": np.column_stack([across, z]).tolist(), "pixels": (pixels + 0.5).tolist()})


def colmap(table):
    """All cameras of cameras.py, as COLMAP's binary form."""
    made = pycolmap.Reconstruction()
    for line in (ROOT / "calibrations" / "cameras.txt").read_text().splitlines():
        if line.startswith("#"):
            continue
        number, model, width, height, *parameters = line.split()
        made.add_camera(pycolmap.Camera(model=model, width=int(width), height=int(height), params=[float(p) for p in parameters],
                                        camera_id=int(number)))
    made.write_binary(str(FILES))
    for path in FILES.glob("*.bin"):
        if path.name not in ("cameras.bin",):
            path.unlink()
    for number, camera in sorted(made.cameras.items()):
        def project(points):
            return np.array([camera.img_from_cam(p[None, :])[0] for p in points])
        table.add("cameras.bin", "colmap", project, camera=str(number), offset=0.0, size=[camera.width, camera.height])


def rig():
    """What the binary wrote is accepted."""
    for path in sorted((RIG / "kalibr").glob("*.yaml")):
        for camera in yaml.safe_load(path.read_text()).values():
            kalibr_camera(camera)
    for path in sorted((RIG / "ros").glob("*.yaml")):
        if path.name != "static_transforms.yaml":
            ros_seen(np.array([[0.1, 0.2, 1.0]]), *ros_file(path))


def main():
    FILES.mkdir(exist_ok=True)
    for path in FILES.iterdir():
        path.unlink()
    table = Table()
    opencv(table)
    ros(table)
    kalibr(table)
    camodocal(table)
    colmap(table)
    rig()
    figures = {"programs": [f"OpenCV {cv2.__version__}", f"pycolmap {pycolmap.__version__}", f"PyYAML {yaml.__version__}"], "cameras": table.entries}
    (ROOT / "field_calibrations.json").write_text(json.dumps(figures) + "\n")


if __name__ == "__main__":
    main()
