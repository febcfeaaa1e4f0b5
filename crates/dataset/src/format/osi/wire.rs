//! Protocol buffers on the wire (Google, encoding of proto2): fields of a message one after the other, each with its number and how long it is.

/// How a field's bytes are counted.
mod wire_type {
    pub(super) const VARINT: u64 = 0;
    pub(super) const FIXED_64: u64 = 1;
    pub(super) const LENGTH: u64 = 2;
}

/// A message that grows field by field.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Message(Vec<u8>);

impl Message {
    /// The bytes.
    pub(super) fn bytes(&self) -> &[u8] {
        &self.0
    }

    /// A number without a sign, or an enumeration; also a signed one, as its two's complement.
    pub(super) fn varint(mut self, field: u64, value: u64) -> Self {
        self.key(field, wire_type::VARINT);
        self.push(value);
        self
    }

    /// A `double`.
    pub(super) fn double(mut self, field: u64, value: f64) -> Self {
        self.key(field, wire_type::FIXED_64);
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    /// A text.
    pub(super) fn text(self, field: u64, text: &str) -> Self {
        self.counted(field, text.as_bytes())
    }

    /// A message within the message.
    pub(super) fn message(self, field: u64, message: &Self) -> Self {
        self.counted(field, &message.0)
    }

    fn counted(mut self, field: u64, bytes: &[u8]) -> Self {
        self.key(field, wire_type::LENGTH);
        self.push(bytes.len() as u64);
        self.0.extend_from_slice(bytes);
        self
    }

    fn key(&mut self, field: u64, wire_type: u64) {
        self.push(field << 3 | wire_type);
    }

    /// Seven bits a byte, the lowest first; the eighth says that more follow.
    fn push(&mut self, mut value: u64) {
        while value >= 0x80 {
            self.0.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.0.push(value as u8);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The examples of the encoding's own description.
    #[test]
    fn bytes_are_those_of_the_description() {
        assert_eq!(Message::default().varint(1, 150).bytes(), [0x08, 0x96, 0x01]);
        assert_eq!(
            Message::default().text(2, "testing").bytes(),
            [0x12, 0x07, 0x74, 0x65, 0x73, 0x74, 0x69, 0x6e, 0x67]
        );
        let inner = Message::default().varint(1, 150);
        assert_eq!(Message::default().message(3, &inner).bytes(), [0x1a, 0x03, 0x08, 0x96, 0x01]);
        assert_eq!(
            Message::default().varint(1, (-2_i64) as u64).bytes(),
            [0x08, 0xfe, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01]
        );
        assert_eq!(Message::default().double(1, 1.0).bytes(), [0x09, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f]);
    }
}
