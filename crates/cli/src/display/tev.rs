//! Packets of the protocol of tev (github.com/Tom94/tev, `src/Ipc.cpp`), which other viewers also use.
//!
//! A packet consists of its length in bytes (u32, itself included), a byte with its type, and its fields. Numbers are little-endian, texts end with a
//! zero byte, `grab focus` is a byte.
//!
//! | packet | byte | fields |
//! | --- | --- | --- |
//! | create an image | 4 | grab focus, name, width (i32), height (i32), channels (i32), their names |
//! | update an image | 6 (third version) | grab focus, name, channels (i32), their names, x, y, width, height (i32 each), of each channel where its values begin (i64, in values) and how far one is from the next (i64), values (f32) |

const CREATE_IMAGE: u8 = 4;
const UPDATE_IMAGE_V3: u8 = 6;

struct TevPacket(Vec<u8>);

impl TevPacket {
    fn new(kind: u8) -> Self {
        Self(vec![0, 0, 0, 0, kind])
    }

    fn flag(mut self, value: bool) -> Self {
        self.0.push(value.into());
        self
    }

    fn text(mut self, text: &str) -> Self {
        self.0.extend(text.bytes().filter(|byte| *byte != 0));
        self.0.push(0);
        self
    }

    fn texts(self, texts: &[&str]) -> Self {
        texts.iter().fold(self, |packet, text| packet.text(text))
    }

    fn integers(mut self, numbers: &[u32]) -> Self {
        numbers.iter().for_each(|number| self.0.extend(number.to_le_bytes()));
        self
    }

    fn long(mut self, numbers: impl Iterator<Item = u64>) -> Self {
        numbers.for_each(|number| self.0.extend(number.to_le_bytes()));
        self
    }

    fn floats(mut self, numbers: &[f32]) -> Self {
        numbers.iter().for_each(|number| self.0.extend(number.to_le_bytes()));
        self
    }

    fn finish(mut self) -> Vec<u8> {
        let length = self.0.len() as u32;
        self.0[..4].copy_from_slice(&length.to_le_bytes());
        self.0
    }
}

/// Creates an image with this number of columns and rows.
pub fn create_image(name: &str, [width, height]: [u32; 2], channels: &[&str]) -> Vec<u8> {
    let count = channels.len() as u32;
    TevPacket::new(CREATE_IMAGE).flag(true).text(name).integers(&[width, height, count]).texts(channels).finish()
}

/// Updates a rectangle, given by its first column and row and its size; the channels' values follow one another.
pub fn update_image(name: &str, channels: &[&str], first: [u32; 2], size: [u32; 2], values: &[f32]) -> Vec<u8> {
    let (count, length) = (channels.len() as u32, u64::from(size[0]) * u64::from(size[1]));
    TevPacket::new(UPDATE_IMAGE_V3)
        .flag(false)
        .text(name)
        .integers(&[count])
        .texts(channels)
        .integers(&[first[0], first[1], size[0], size[1]])
        .long((0..u64::from(count)).map(|channel| channel * length))
        .long((0..count).map(|_| 1))
        .floats(values)
        .finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_are_those_of_the_protocol() {
        let create = create_image("a", [3, 2], &["R", "G"]);
        assert_eq!(create, b"\x18\0\0\0\x04\x01a\0\x03\0\0\0\x02\0\0\0\x02\0\0\0R\0G\0");
        let update = update_image("a", &["Y"], [1, 0], [2, 1], &[1.0, -2.0]);
        let expected = b"\x36\0\0\0\x06\0a\0\x01\0\0\0Y\0\x01\0\0\0\0\0\0\0\x02\0\0\0\x01\0\0\0\0\0\0\0\0\0\0\0\x01\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\xc0";
        assert_eq!(update, expected);
    }
}
