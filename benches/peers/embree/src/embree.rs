//! Embree 4, from a shared library that is found at run time.
//!
//! Only what a triangle mesh and single rays need. Layouts and numbers are those of Embree 4's public interface
//! (rtcore_ray.h, rtcore_geometry.h, rtcore_buffer.h, rtcore_scene.h).

use crate::heap;
use core::ffi::{c_char, c_int, c_uint, c_void};
use core::mem::ManuallyDrop;
use core::ptr::{null, null_mut};
use etendue_core::Ray;
use etendue_tracer::geometry::Mesh;
use libloading::Library;
use std::ffi::CString;
use std::path::Path;

type Handle = *mut c_void;
type Query = unsafe extern "C" fn(Handle, *mut RayHit, *const c_void);

const TRIANGLES: c_int = 0;
const INDEX_BUFFER: c_int = 0;
const VERTEX_BUFFER: c_int = 1;
const UINT3: c_int = 0x5003;
const FLOAT3: c_int = 0x9003;
const NO_ID: c_uint = u32::MAX;

/// How a scene is built and asked.
#[derive(Clone, Copy, Debug)]
pub struct Mode {
    /// RTC_SCENE_FLAG_…
    pub flags: c_int,
    /// RTC_BUILD_QUALITY_…
    pub quality: c_int,
}

/// Default quality and flags.
pub const DEFAULT: Mode = Mode { flags: 0, quality: 1 };
/// RTC_SCENE_FLAG_ROBUST: watertight.
pub const ROBUST: Mode = Mode { flags: 4, quality: 1 };
/// RTC_BUILD_QUALITY_HIGH: triangles may be split.
pub const HIGH: Mode = Mode { flags: 0, quality: 2 };
/// Both.
pub const ROBUST_HIGH: Mode = Mode { flags: 4, quality: 2 };

/// RTCRayHit, with room for the instance ids of every version.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
struct RayHit {
    origin: [f32; 3],
    t_near: f32,
    direction: [f32; 3],
    time: f32,
    t_far: f32,
    mask: c_uint,
    id: c_uint,
    flags: c_uint,
    normal: [f32; 3],
    u: f32,
    v: f32,
    primitive: c_uint,
    geometry: c_uint,
    instances: [c_uint; 5],
}

/// What Embree says a ray meets first.
#[derive(Clone, Copy, Debug)]
pub struct Met {
    /// In lengths of the direction.
    pub t: f32,
    /// The triangle.
    pub primitive: u32,
}

/// The library, with a device for one thread.
pub struct Embree {
    device: Handle,
    intersect: Query,
    occluded: Query,
    /// Never closed: threads of its own may outlive the device.
    library: ManuallyDrop<Library>,
}

/// A built scene of one mesh, whose buffers it borrows.
pub struct Scene<'a> {
    embree: &'a Embree,
    scene: Handle,
    _mesh: &'a Mesh,
}

impl Embree {
    /// Opens the library with one thread of its own, and with no larger instruction set than `isa`, in Embree's words.
    pub fn open(path: &Path, isa: Option<&str>) -> Result<Self, libloading::Error> {
        Self::configured(path, isa, "")
    }

    /// As [`Embree::open`]; it says on the standard output what it does.
    pub fn verbose(path: &Path, isa: Option<&str>) -> Result<Self, libloading::Error> {
        Self::configured(path, isa, ",verbose=2")
    }

    fn configured(path: &Path, isa: Option<&str>, more: &str) -> Result<Self, libloading::Error> {
        let isa = isa.map_or_else(String::new, |isa| format!(",max_isa={isa}"));
        let config = CString::new(format!("threads=1,set_affinity=0{isa}{more}")).expect("words without zeros");
        // SAFETY: a library of this name runs nothing but its own initialisation; the signatures are those of Embree 4.
        unsafe {
            let library = Library::new(path)?;
            let new_device = *library.get::<unsafe extern "C" fn(*const c_char) -> Handle>(b"rtcNewDevice")?;
            let device = new_device(config.as_ptr());
            type Watch = unsafe extern "C" fn(Handle, extern "C" fn(Handle, isize, bool) -> bool, Handle);
            let watch = *library.get::<Watch>(b"rtcSetDeviceMemoryMonitorFunction")?;
            watch(device, heap::monitor, null_mut());
            let (intersect, occluded) =
                (*library.get::<Query>(b"rtcIntersect1")?, *library.get::<Query>(b"rtcOccluded1")?);
            Ok(Self { device, intersect, occluded, library: ManuallyDrop::new(library) })
        }
    }

    /// Builds a scene of a mesh.
    pub fn scene<'a>(&'a self, mesh: &'a Mesh, mode: Mode) -> Scene<'a> {
        // SAFETY: signatures are those of Embree 4; the buffers outlive the scene, which borrows the mesh.
        unsafe {
            let scene = self.call::<unsafe extern "C" fn(Handle) -> Handle>(b"rtcNewScene")(self.device);
            self.call::<unsafe extern "C" fn(Handle, c_int)>(b"rtcSetSceneFlags")(scene, mode.flags);
            self.call::<unsafe extern "C" fn(Handle, c_int)>(b"rtcSetSceneBuildQuality")(scene, mode.quality);
            let geometry = self.geometry(mesh, mode.quality);
            self.call::<unsafe extern "C" fn(Handle, Handle) -> c_uint>(b"rtcAttachGeometry")(scene, geometry);
            self.call::<unsafe extern "C" fn(Handle)>(b"rtcReleaseGeometry")(geometry);
            self.call::<unsafe extern "C" fn(Handle)>(b"rtcCommitScene")(scene);
            assert_eq!(self.error(), 0, "Embree reports an error");
            Scene { embree: self, scene, _mesh: mesh }
        }
    }

    unsafe fn geometry(&self, mesh: &Mesh, quality: c_int) -> Handle {
        type Share = unsafe extern "C" fn(Handle, c_int, c_uint, c_int, *const c_void, usize, usize, usize);
        // SAFETY: as the caller's; twelve bytes an item, as told.
        unsafe {
            let geometry =
                self.call::<unsafe extern "C" fn(Handle, c_int) -> Handle>(b"rtcNewGeometry")(self.device, TRIANGLES);
            let set_buffer = self.call::<Share>(b"rtcSetSharedGeometryBuffer");
            let (points, triangles) = (mesh.positions(), mesh.triangles());
            set_buffer(geometry, VERTEX_BUFFER, 0, FLOAT3, points.as_ptr().cast(), 0, 12, points.len());
            set_buffer(geometry, INDEX_BUFFER, 0, UINT3, triangles.as_ptr().cast(), 0, 12, triangles.len());
            self.call::<unsafe extern "C" fn(Handle, c_int)>(b"rtcSetGeometryBuildQuality")(geometry, quality);
            self.call::<unsafe extern "C" fn(Handle)>(b"rtcCommitGeometry")(geometry);
            geometry
        }
    }

    fn error(&self) -> c_int {
        // SAFETY: the signature is that of Embree 4.
        unsafe { self.call::<unsafe extern "C" fn(Handle) -> c_int>(b"rtcGetDeviceError")(self.device) }
    }

    /// A function of the library. The caller names its signature.
    unsafe fn call<F: Copy>(&self, name: &[u8]) -> F {
        // SAFETY: as the caller's.
        unsafe { *self.library.get::<F>(name).expect("Embree 4 has this function") }
    }
}

impl Drop for Embree {
    fn drop(&mut self) {
        // SAFETY: the signature is that of Embree 4; scenes borrow this and are gone.
        unsafe { self.call::<unsafe extern "C" fn(Handle)>(b"rtcReleaseDevice")(self.device) }
    }
}

impl Scene<'_> {
    /// The first triangle that a ray meets.
    #[inline]
    pub fn closest(&self, ray: &Ray) -> Option<Met> {
        let mut query = question(ray);
        // SAFETY: the scene is committed; the ray has the layout and alignment of RTCRayHit. No arguments are legal.
        unsafe { (self.embree.intersect)(self.scene, &raw mut query, null()) };
        (query.geometry != NO_ID).then_some(Met { t: query.t_far, primitive: query.primitive })
    }

    /// Whether a ray meets anything.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        let mut query = question(ray);
        // SAFETY: as above; an RTCRay is the beginning of an RTCRayHit.
        unsafe { (self.embree.occluded)(self.scene, &raw mut query, null()) };
        query.t_far < 0.0
    }
}

impl Drop for Scene<'_> {
    fn drop(&mut self) {
        // SAFETY: the signature is that of Embree 4.
        unsafe { self.embree.call::<unsafe extern "C" fn(Handle)>(b"rtcReleaseScene")(self.scene) }
    }
}

#[inline]
fn question(ray: &Ray) -> RayHit {
    RayHit {
        origin: ray.origin.to_array(),
        t_near: 0.0,
        direction: ray.direction.to_array(),
        time: 0.0,
        t_far: ray.t_max,
        mask: u32::MAX,
        id: 0,
        flags: 0,
        normal: [0.0; 3],
        u: 0.0,
        v: 0.0,
        primitive: NO_ID,
        geometry: NO_ID,
        instances: [NO_ID; 5],
    }
}
