//! Which channel of a sensor was measured, and where its pixels are.

use etendue_sensor::SensorParameters;

/// The channel that was measured, by its name or its first letter.
pub(crate) fn channel(p: &SensorParameters, measured: Option<&str>) -> Result<usize, String> {
    let names = || p.channels.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ");
    let Some(name) = measured else {
        let several = || format!("the pixels have colours ({}): measure one with `channel`", names());
        return if p.channels.len() == 1 { Ok(0) } else { Err(several()) };
    };
    let alike = |own: &str| own.eq_ignore_ascii_case(name) || (name.len() == 1 && own[..1].eq_ignore_ascii_case(name));
    let found = p.channels.iter().position(|c| alike(&c.name));
    found.ok_or_else(|| format!("the channel '{name}' was measured; the file has {}", names()))
}

/// The first place of a channel in the tile, which is the one that measurements take.
pub(crate) fn place_of(p: &SensorParameters, channel: usize) -> [usize; 2] {
    let at = p.cfa.channels().iter().position(|c| *c == channel).unwrap_or(0);
    [at % p.cfa.width(), at / p.cfa.width()]
}
