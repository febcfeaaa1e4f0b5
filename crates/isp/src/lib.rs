//! Raw digital numbers to a picture: black level, white balance, demosaic, colour, tone.
