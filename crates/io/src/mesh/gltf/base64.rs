//! Bytes within text: data URIs and escaped names.

/// The bytes of a data URI; `None` where it is none, an error in words where it is damaged.
pub(super) fn data_uri(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let (head, body) = uri.strip_prefix("data:")?.split_once(',').unwrap_or(("", ""));
    if head.ends_with(";base64") {
        return Some(decode(body).ok_or_else(|| "its data URI is no base64".to_owned()));
    }
    Some(Err("its data URI is not in base64; export it with base64, or as a file".to_owned()))
}

fn decode(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for group in text.chunks(4) {
        let mut bits = 0_u32;
        for character in group {
            bits = bits << 6 | value(*character)?;
        }
        match group.len() {
            4 => bytes.extend_from_slice(&bits.to_be_bytes()[1..]),
            3 => bytes.extend_from_slice(&(bits >> 2).to_be_bytes()[2..]),
            2 => bytes.push((bits >> 4) as u8),
            _ => return None,
        }
    }
    Some(bytes)
}

fn value(character: u8) -> Option<u32> {
    let value = match character {
        b'A'..=b'Z' => character - b'A',
        b'a'..=b'z' => character - b'a' + 26,
        b'0'..=b'9' => character - b'0' + 52,
        b'+' | b'-' => 62,
        b'/' | b'_' => 63,
        _ => return None,
    };
    Some(value.into())
}

/// A relative reference with its `%20` and the like as characters; as it is where they are none.
pub(super) fn unescaped(uri: &str) -> String {
    let (mut bytes, mut rest) = (Vec::with_capacity(uri.len()), uri.as_bytes());
    while let Some((first, tail)) = rest.split_first() {
        let hex = tail.get(..2).and_then(|h| std::str::from_utf8(h).ok()).and_then(|h| u8::from_str_radix(h, 16).ok());
        match (first, hex) {
            (b'%', Some(byte)) => {
                bytes.push(byte);
                rest = &tail[2..];
            }
            _ => {
                bytes.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8(bytes).unwrap_or_else(|_| uri.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vectors_of_rfc_4648() {
        let vectors =
            [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9vYg==", "foob"), ("Zm9vYmFy", "foobar")];
        for (text, bytes) in vectors {
            let uri = format!("data:application/octet-stream;base64,{text}");
            assert_eq!(data_uri(&uri), Some(Ok(bytes.as_bytes().to_vec())), "{text}");
        }
        assert!(
            data_uri("data:;base64,Z").is_some_and(|r| r.is_err())
                && data_uri("data:;base64,Zg!=").is_some_and(|r| r.is_err())
        );
        assert!(data_uri("data:text/plain,abc").is_some_and(|r| r.is_err()));
        assert_eq!(data_uri("data.bin"), None);
    }

    #[test]
    fn names_are_unescaped() {
        assert_eq!(unescaped("my%20wall%C3%A9.png"), "my wallé.png");
        assert_eq!(unescaped("50%.png"), "50%.png");
    }
}
