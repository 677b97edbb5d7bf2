//! Parsers of single options: from typed text to a checked number, vector, size, range or list.
//!
//! Their messages become part of clap's, which names the option and the typed text.

use glam::DVec3;

/// Largest number of pixels. More are a typing error, and more than a picture's buffers should
/// take.
const MAX_PIXELS: u64 = 1 << 26;
/// Longest edge of a picture in pixels.
const MAX_EDGE: u32 = 16_384;

/// Reads a finite number.
pub fn number(text: &str) -> Result<f64, String> {
    let value: f64 = text.trim().parse().map_err(|_| format!("{text:?} is not a number"))?;
    if value.is_finite() { Ok(value) } else { Err(format!("{value} is not a finite number")) }
}

/// Reads a finite number greater than 0.
pub fn positive(text: &str) -> Result<f64, String> {
    number(text).and_then(|v| if v > 0.0 { Ok(v) } else { Err(format!("{v} is not greater than 0")) })
}

/// Reads a number greater than 0; `inf` is allowed.
pub fn positive_or_infinite(text: &str) -> Result<f64, String> {
    match text.trim().to_ascii_lowercase().as_str() {
        "inf" | "infinity" | "+inf" => Ok(f64::INFINITY),
        _ => positive(text),
    }
}

/// Reads a number in 0..=1.
pub fn share(text: &str) -> Result<f64, String> {
    number(text)
        .and_then(|v| if (0.0..=1.0).contains(&v) { Ok(v) } else { Err(format!("{v} is out of range; give 0 to 1")) })
}

/// Reads an angle in degrees between 0 and 180, both excluded.
pub fn field_of_view(text: &str) -> Result<f64, String> {
    let angle = number(text)?;
    if angle > 0.0 && angle < 180.0 {
        Ok(angle)
    } else {
        Err(format!("{angle} degrees; give an angle between 0 and 180, both excluded"))
    }
}

/// Reads the sun's angle in degrees, 0 to 90.
pub fn sun_angle(text: &str) -> Result<f64, String> {
    let angle = number(text)?;
    if (0.0..=90.0).contains(&angle) { Ok(angle) } else { Err(format!("{angle} degrees; give an angle from 0 to 90")) }
}

/// Reads `x,y,z`, three finite numbers.
pub fn vector(text: &str) -> Result<DVec3, String> {
    match numbers(text)?[..] {
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        ref other => Err(format!("{} numbers; give three: x,y,z", other.len())),
    }
}

/// Reads `x,y,z`, not all zero.
pub fn direction(text: &str) -> Result<DVec3, String> {
    let v = vector(text)?;
    let length = v.length();
    if length > 0.0 && length.is_finite() { Ok(v) } else { Err("a vector of that length has no direction".into()) }
}

/// Reads `r,g,b`, each from 0 to 1.
pub fn colour(text: &str) -> Result<DVec3, String> {
    let colour = vector(text)?;
    let inside = colour.cmpge(DVec3::ZERO).all() && colour.cmple(DVec3::ONE).all();
    if inside { Ok(colour) } else { Err(format!("{colour} is not a colour; give red, green and blue from 0 to 1")) }
}

/// Reads `a,b,…`, at least one finite number.
pub fn numbers(text: &str) -> Result<Vec<f64>, String> {
    text.split(',').map(number).collect()
}

/// Reads rising planes `a,b,…`: finite view depths greater than 0.
pub fn planes(text: &str) -> Result<Vec<f64>, String> {
    let planes: Vec<f64> = text.split(',').map(positive).collect::<Result<_, _>>()?;
    match planes.windows(2).find(|pair| pair[0] >= pair[1]) {
        Some(pair) => Err(format!("{} does not come before {}; give the planes from near to far", pair[0], pair[1])),
        None => Ok(planes),
    }
}

/// Reads edges of maps in texels: one, or one per split.
pub fn map_sizes(text: &str) -> Result<Vec<u32>, String> {
    text.split(',')
        .map(|edge| match edge.trim().parse::<u32>() {
            Ok(edge) if (1..=1 << 16).contains(&edge) => Ok(edge),
            Ok(edge) => Err(format!("{edge} texels; give 1 to 65536")),
            Err(_) => Err(format!("{edge:?} is not a whole number of texels, 1 to 65536")),
        })
        .collect()
}

/// Reads a number between 0 and 1, both excluded.
pub fn focus(text: &str) -> Result<f64, String> {
    number(text).and_then(|v| {
        if v > 0.0 && v < 1.0 { Ok(v) } else { Err(format!("{v} is not between 0 and 1, both excluded")) }
    })
}

/// Reads `WIDTHxHEIGHT` in pixels.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let form = || format!("{text:?} is not a size; give WIDTHxHEIGHT in pixels, such as 800x600");
    let (width, height) = text.split_once(['x', 'X', '×']).ok_or_else(form)?;
    let edge = |text: &str| text.trim().parse::<u32>().map_err(|_| form());
    let [width, height] = [edge(width)?, edge(height)?];
    if width == 0 || height == 0 {
        return Err("a picture has at least one pixel each way".into());
    }
    if width > MAX_EDGE || height > MAX_EDGE || u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(format!("larger than {MAX_EDGE} pixels a side or {MAX_PIXELS} in all"));
    }
    Ok([width, height])
}

/// Reads `N..F`: view depths in metres, 0 < N < F.
pub fn range(text: &str) -> Result<(f64, f64), String> {
    let (near, far) =
        text.split_once("..").ok_or_else(|| format!("{text:?} is not a range; give N..F in metres, such as 1..800"))?;
    let (near, far) = (positive(near)?, positive(far)?);
    if near < far { Ok((near, far)) } else { Err(format!("near ({near}) has to be less than far ({far})")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_take_minus_signs_and_refuse_what_is_no_number() {
        assert_eq!(vector("-1,-2,0.5"), Ok(DVec3::new(-1.0, -2.0, 0.5)));
        assert_eq!(vector(" 1, 2e3 ,-.5"), Ok(DVec3::new(1.0, 2000.0, -0.5)));
        for bad in ["", "1,2", "1,2,3,4", "1,,3", "nan,0,1", "0,inf,0", "1;2;3", "--eye"] {
            assert!(vector(bad).is_err(), "{bad}");
        }
        assert!(direction("0,0,0").is_err());
        assert!(direction("1e200,1e200,1e200").is_err(), "its length overflows");
    }

    #[test]
    fn colours_are_three_shares() {
        assert_eq!(colour("0,0.5,1"), Ok(DVec3::new(0.0, 0.5, 1.0)));
        for bad in ["", "0.5", "0,0,1.01", "-0.1,0,0", "nan,0,0", "red"] {
            assert!(colour(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn sizes_are_two_whole_positive_numbers() {
        assert_eq!(size("800x600"), Ok([800, 600]));
        assert_eq!(size("1X1"), Ok([1, 1]));
        for bad in ["800", "0x5", "5x0", "-1x5", "1.5x2", "16385x1", "16384x16384", "99999999999x1", "x", "1x2x3"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn ranges_rise() {
        assert_eq!(range("1..800"), Ok((1.0, 800.0)));
        assert_eq!(range("0.5..2.5e3"), Ok((0.5, 2500.0)));
        for bad in ["1", "1..", "..5", "5..1", "1..1", "0..5", "-1..5", "nan..5", "1..nan", "1..inf"] {
            assert!(range(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn lists_and_shares() {
        assert_eq!(map_sizes("1024,512,512,256"), Ok(vec![1024, 512, 512, 256]));
        assert_eq!(planes("5,25.5,100"), Ok(vec![5.0, 25.5, 100.0]));
        assert_eq!(share("1"), Ok(1.0));
        assert_eq!(positive_or_infinite("inf"), Ok(f64::INFINITY));
        for bad in ["", "0", "-5", "1.5", "65537", "512,", "512,,256"] {
            assert!(map_sizes(bad).is_err(), "{bad}");
        }
        for bad in ["25,5", "5,5", "-1,5", "nan", "0,5"] {
            assert!(planes(bad).is_err(), "{bad}");
        }
        for bad in ["1.01", "-0.1", "nan", "half"] {
            assert!(share(bad).is_err() && focus(bad).is_err(), "{bad}");
        }
        assert!(focus("0").is_err() && focus("1").is_err());
        for bad in ["-1", "90.5", "nan", "inf", "wide"] {
            assert!(sun_angle(bad).is_err(), "{bad}");
        }
        assert_eq!((sun_angle("0"), sun_angle("0.53")), (Ok(0.0), Ok(0.53)));
        for bad in ["0", "180", "-60", "nan"] {
            assert!(field_of_view(bad).is_err(), "{bad}");
        }
        for bad in ["-inf", "nan", "0"] {
            assert!(positive_or_infinite(bad).is_err(), "{bad}");
        }
    }
}
