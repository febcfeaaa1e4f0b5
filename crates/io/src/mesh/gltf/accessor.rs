//! Reader of the numbers of accessors, with every bound checked.

use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};

use super::buffers::Buffers;

/// The numbers of an accessor of `N` components, one array per element; integers as numbers, normalised ones 0 … 1 or −1 … 1.
pub(super) fn numbers<const N: usize>(
    root: &Root,
    buffers: &Buffers,
    index: Index<Accessor>,
    what: &str,
) -> Result<Vec<[f64; N]>, String> {
    let number = index.value();
    let message = |problem: &str| format!("accessor {number} ({what}) {problem}");
    let accessor = root.accessors.get(number).ok_or_else(|| message("does not exist"))?;
    let (Checked::Valid(kind), Checked::Valid(component)) = (&accessor.type_, &accessor.component_type) else {
        return Err(message("has an unknown type"));
    };
    let (components, component) = (components(*kind), component.0);
    if components != N {
        return Err(message(&format!("has {components} numbers per element; expected {N}")));
    }
    let count = usize::try_from(accessor.count.0).map_err(|_| message("is too long"))?;
    let decode = |bytes: &[u8]| -> [f64; N] {
        let size = component.size();
        std::array::from_fn(|i| number_of(&bytes[i * size..(i + 1) * size], component, accessor.normalized))
    };
    let element = element_size(N, component);
    let mut values = match accessor.buffer_view {
        None => {
            // The length of an accessor with only a sparse part is limited by the count of that part.
            let max_count = accessor.sparse.as_ref().map_or(0, |sparse| sparse.count.0.saturating_mul(64).max(1 << 16));
            if accessor.count.0 > max_count {
                return Err(message("has no data"));
            }
            vec![[0.0; N]; count]
        }
        Some(view) => {
            let view = root
                .buffer_views
                .get(view.value())
                .ok_or_else(|| message("refers to a buffer view that does not exist"))?;
            let bytes = buffers.view(view).map_err(|problem| message(&format!("refers to {problem}")))?;
            let stride = view.byte_stride.map_or(element, |stride| stride.0);
            let offset = accessor.byte_offset.unwrap_or_default().0;
            elements(bytes, offset, stride, element, count)
                .ok_or_else(|| message("extends beyond its buffer view"))?
                .map(decode)
                .collect()
        }
    };
    if let Some(sparse) = &accessor.sparse {
        let Checked::Valid(indices_type) = &sparse.indices.component_type else {
            return Err(message("has an unknown type"));
        };
        let many = usize::try_from(sparse.count.0).map_err(|_| message("is too long"))?;
        let part = |view: Index<gltf::json::buffer::View>, offset: u64, size: usize| {
            let view = root
                .buffer_views
                .get(view.value())
                .ok_or_else(|| message("refers to a buffer view that does not exist"))?;
            let bytes = buffers.view(view).map_err(|problem| message(&format!("refers to {problem}")))?;
            elements(bytes, offset, size, size, many).ok_or_else(|| message("extends beyond its buffer view"))
        };
        let places = part(sparse.indices.buffer_view, sparse.indices.byte_offset.0, indices_type.0.size())?;
        let new = part(sparse.values.buffer_view, sparse.values.byte_offset.0, element)?;
        for (place, value) in places.zip(new) {
            let place = number_of(place, indices_type.0, false) as usize;
            *values.get_mut(place).ok_or_else(|| message("has a sparse index beyond its end"))? = decode(value);
        }
    }
    Ok(values)
}

/// Elements in order; `None` if the last one is incomplete.
fn elements(
    bytes: &[u8],
    offset: u64,
    stride: usize,
    element: usize,
    count: usize,
) -> Option<impl Iterator<Item = &[u8]>> {
    let offset = usize::try_from(offset).ok()?;
    if stride < element {
        return None;
    }
    let needed = match count.checked_sub(1) {
        None => 0,
        Some(before) => before.checked_mul(stride)?.checked_add(element)?.checked_add(offset)?,
    };
    let bytes = if count == 0 { &[][..] } else { bytes.get(offset..).filter(|_| needed <= bytes.len())? };
    Some((0..count).map(move |i| &bytes[i * stride..i * stride + element]))
}

fn components(kind: Type) -> usize {
    match kind {
        Type::Scalar => 1,
        Type::Vec2 => 2,
        Type::Vec3 => 3,
        Type::Vec4 | Type::Mat2 => 4,
        Type::Mat3 => 9,
        Type::Mat4 => 16,
    }
}

/// Bytes per element. Columns of matrices of small integers are padded, which does not affect the 4 × 4 matrices and floats used here.
fn element_size(components: usize, component: ComponentType) -> usize {
    components * component.size()
}

fn number_of(bytes: &[u8], component: ComponentType, normalised: bool) -> f64 {
    let (value, max_value) = match (component, bytes) {
        (ComponentType::I8, [a]) => (f64::from(*a as i8), f64::from(i8::MAX)),
        (ComponentType::U8, [a]) => (f64::from(*a), f64::from(u8::MAX)),
        (ComponentType::I16, [a, b]) => (f64::from(i16::from_le_bytes([*a, *b])), f64::from(i16::MAX)),
        (ComponentType::U16, [a, b]) => (f64::from(u16::from_le_bytes([*a, *b])), f64::from(u16::MAX)),
        (ComponentType::U32, [a, b, c, d]) => (f64::from(u32::from_le_bytes([*a, *b, *c, *d])), 1.0),
        (ComponentType::F32, [a, b, c, d]) => (f64::from(f32::from_le_bytes([*a, *b, *c, *d])), 1.0),
        _ => (f64::NAN, 1.0),
    };
    if normalised { (value / max_value).max(-1.0) } else { value }
}

/// Refuses numbers that are not finite.
pub(super) fn finite<const N: usize>(values: Vec<[f64; N]>, what: &str) -> Result<Vec<[f64; N]>, String> {
    match values.iter().position(|v| v.iter().any(|c| !c.is_finite())) {
        Some(place) => Err(format!(
            "the {what} of vertex {place} is {:?}; expected finite numbers: correct the model",
            values[place]
        )),
        None => Ok(values),
    }
}
