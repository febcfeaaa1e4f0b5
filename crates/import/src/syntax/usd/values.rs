//! Conversion of `openusd` values to plain types.

use openusd::gf::f16;
use openusd::sdf::{AssetPath, Value};

use super::layers::Layers;
use super::tree::{UsdAsset, UsdValue};

/// 64-bit number for a 32-bit one: the shortest decimal that reads back to it.
fn short(v: f32) -> f64 {
    v.to_string().parse().unwrap_or_else(|_| v.into())
}

/// A tuple.
fn one<T, const N: usize>(value: impl Into<[T; N]>, number: impl Fn(T) -> f64) -> UsdValue {
    UsdValue::Tuple(value.into().map(number).to_vec())
}

/// An array of tuples.
fn many<T, const N: usize>(list: &[impl Copy + Into<[T; N]>], number: impl Fn(T) -> f64) -> UsdValue {
    let mut flat = Vec::with_capacity(N * list.len());
    for value in list {
        flat.extend((*value).into().map(&number));
    }
    UsdValue::Tuples(N, flat)
}

fn half(v: f16) -> f64 {
    v.to_f32().into()
}

fn numbers<T: Copy>(list: &[T], number: impl Fn(T) -> f64) -> UsdValue {
    UsdValue::Numbers(list.iter().map(|value| number(*value)).collect())
}

/// Matrices of `N` numbers.
fn matrices<'a, const N: usize>(list: impl Iterator<Item = &'a [f64; N]>) -> UsdValue {
    UsdValue::Tuples(N, list.flatten().copied().collect())
}

fn asset(path: &AssetPath, layers: &Layers) -> UsdAsset {
    UsdAsset { stated: path.asset_path().to_owned(), file: path.resolved_path().and_then(|path| layers.file(path)) }
}

/// `None` if the value is empty.
pub(super) fn plain(value: Value, layers: &Layers) -> Option<UsdValue> {
    Some(match value {
        Value::None | Value::ValueBlock => return None,
        Value::Bool(v) => UsdValue::Flag(v),
        Value::BoolVec(v) => numbers(&v, |v| f64::from(u8::from(v))),
        Value::Uchar(v) => UsdValue::Number(v.into()),
        Value::UcharVec(v) => numbers(&v, f64::from),
        Value::Int(v) => UsdValue::Number(v.into()),
        Value::IntVec(v) => numbers(&v, f64::from),
        Value::Uint(v) => UsdValue::Number(v.into()),
        Value::UintVec(v) => numbers(&v, f64::from),
        Value::Int64(v) => UsdValue::Number(v as f64),
        Value::Int64Vec(v) => numbers(&v, |v| v as f64),
        Value::Uint64(v) => UsdValue::Number(v as f64),
        Value::Uint64Vec(v) => numbers(&v, |v| v as f64),
        Value::Half(v) => UsdValue::Number(half(v)),
        Value::HalfVec(v) => numbers(&v, half),
        Value::Float(v) => UsdValue::Number(short(v)),
        Value::FloatVec(v) => numbers(&v, f64::from),
        Value::Double(v) => UsdValue::Number(v),
        Value::DoubleVec(v) => UsdValue::Numbers(v),
        Value::String(v) => UsdValue::Text(v),
        Value::StringVec(v) => UsdValue::Texts(v),
        Value::Token(v) => UsdValue::Text(v.as_str().to_owned()),
        Value::TokenVec(v) => UsdValue::Texts(v.iter().map(|v| v.as_str().to_owned()).collect()),
        Value::AssetPath(v) => UsdValue::Asset(asset(&v, layers)),
        other => return Some(tuple(other)),
    })
}

fn tuple(value: Value) -> UsdValue {
    match value {
        Value::Vec2h(v) => one(v, half),
        Value::Vec2f(v) => one(v, short),
        Value::Vec2d(v) => one(v, |v: f64| v),
        Value::Vec2i(v) => one(v, |v: i32| v.into()),
        Value::Vec3h(v) => one(v, half),
        Value::Vec3f(v) => one(v, short),
        Value::Vec3d(v) => one(v, |v: f64| v),
        Value::Vec3i(v) => one(v, |v: i32| v.into()),
        Value::Vec4h(v) => one(v, half),
        Value::Vec4f(v) => one(v, short),
        Value::Vec4d(v) => one(v, |v: f64| v),
        Value::Vec4i(v) => one(v, |v: i32| v.into()),
        Value::Quath(v) => one(v, half),
        Value::Quatf(v) => one(v, short),
        Value::Quatd(v) => one(v, |v: f64| v),
        Value::Matrix2d(v) => UsdValue::Tuple(v.0.to_vec()),
        Value::Matrix3d(v) => UsdValue::Tuple(v.0.to_vec()),
        Value::Matrix4d(v) => UsdValue::Tuple(v.0.to_vec()),
        other => tuple_array(other),
    }
}

fn tuple_array(value: Value) -> UsdValue {
    match value {
        Value::Vec2hVec(v) => many(&v, half),
        Value::Vec2fVec(v) => many(&v, |v: f32| v.into()),
        Value::Vec2dVec(v) => many(&v, |v: f64| v),
        Value::Vec2iVec(v) => many(&v, |v: i32| v.into()),
        Value::Vec3hVec(v) => many(&v, half),
        Value::Vec3fVec(v) => many(&v, |v: f32| v.into()),
        Value::Vec3dVec(v) => many(&v, |v: f64| v),
        Value::Vec3iVec(v) => many(&v, |v: i32| v.into()),
        Value::Vec4hVec(v) => many(&v, half),
        Value::Vec4fVec(v) => many(&v, |v: f32| v.into()),
        Value::Vec4dVec(v) => many(&v, |v: f64| v),
        Value::Vec4iVec(v) => many(&v, |v: i32| v.into()),
        Value::QuathVec(v) => many(&v, half),
        Value::QuatfVec(v) => many(&v, |v: f32| v.into()),
        Value::QuatdVec(v) => many(&v, |v: f64| v),
        Value::Matrix2dVec(v) => matrices(v.iter().map(|m| &m.0)),
        Value::Matrix3dVec(v) => matrices(v.iter().map(|m| &m.0)),
        Value::Matrix4dVec(v) => matrices(v.iter().map(|m| &m.0)),
        _ => UsdValue::Other,
    }
}

/// Bytes of a value.
pub(super) fn bytes_of(value: &UsdValue) -> u64 {
    let own = size_of_val(value) as u64;
    own + match value {
        UsdValue::Tuple(list) | UsdValue::Numbers(list) | UsdValue::Tuples(_, list) => 8 * list.len() as u64,
        UsdValue::Text(text) => text.len() as u64,
        UsdValue::Texts(texts) => texts.iter().map(|text| (size_of::<String>() + text.len()) as u64).sum(),
        UsdValue::Asset(asset) => asset.stated.len() as u64,
        UsdValue::Flag(_) | UsdValue::Number(_) | UsdValue::Other => 0,
    }
}
