//! Places and sizes in images.

/// Parses a tile of colour filters: four letters, row by row, as capitals.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn tile(text: &str) -> Result<String, String> {
    let tile = text.to_ascii_uppercase();
    let known = tile.chars().count() == 4 && tile.chars().all(|c| "RGBCMYWE".contains(c));
    known
        .then_some(tile)
        .ok_or_else(|| format!("expected four of the letters R, G, B, C, M, Y, W, E, e.g. RGGB, not '{text}'"))
}

/// Parses a region: left column, top row, width and height.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn region(text: &str) -> Result<[usize; 4], String> {
    let numbers: Option<Vec<usize>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    let expected = || format!("expected X,Y,WIDTH,HEIGHT in whole pixels, not '{text}'");
    let numbers: [usize; 4] = numbers.ok_or_else(expected)?.try_into().map_err(|_| expected())?;
    if numbers[2] > 0 && numbers[3] > 0 { Ok(numbers) } else { Err(expected()) }
}

/// Parses the columns and rows of a grid, each from 2 to 1000.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn grid(text: &str) -> Result<[usize; 2], String> {
    let expected = || format!("expected COLUMNSxROWS, e.g. 11x8, not '{text}'");
    let (columns, rows) = text.split_once(['x', '×']).ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<usize>().ok().filter(|n| (2..=1000).contains(n)).ok_or_else(expected);
    Ok([number(columns)?, number(rows)?])
}

/// Parses the width and height of an image, pixels.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn size(text: &str) -> Result<[usize; 2], String> {
    let expected = || format!("expected WIDTHxHEIGHT in pixels, e.g. 640x480, not '{text}'");
    let (width, height) = text.split_once(['x', '×']).ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<usize>().ok().filter(|n| (1..=1_000_000).contains(n)).ok_or_else(expected);
    Ok([number(width)?, number(height)?])
}

/// Parses two finite numbers.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn place(text: &str) -> Result<[f64; 2], String> {
    let expected = || format!("expected two numbers X,Y, not '{text}'");
    let (x, y) = text.split_once(',').ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(expected);
    Ok([number(x)?, number(y)?])
}

/// Parses two finite numbers as a pair.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn point(text: &str) -> Result<(f64, f64), String> {
    place(text).map(Into::into)
}
