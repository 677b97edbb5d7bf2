//! Every example runs, and its picture has light and shadow where they belong.
#![allow(clippy::duplicate_mod, reason = "each example loads what all of them share")]

use std::error::Error;

use image::RgbImage;

/// An example, its file, points of its picture that are lit and points in shadow.
macro_rules! examples {
    ($($name:ident, $path:literal, lit $lit:expr, dark $dark:expr;)*) => {
        $(
            #[path = $path]
            #[allow(dead_code, reason = "the example's own `main` is not called")]
            mod $name;
        )*

        mod pictures {
            $(
                #[test]
                fn $name() {
                    let Some(picture) = super::drawn(stringify!($name), super::$name::run) else { return };
                    assert_eq!(super::fault(&picture, &$lit, &$dark), None);
                    // The comparison can say no.
                    assert!(super::fault(&picture, &$dark, &$lit).is_some());
                }
            )*
        }
    };
}

examples! {
    hello_shadows, "../examples/hello_shadows.rs", lit [(170, 449)], dark [(589, 423)];
    lamps, "../examples/lamps.rs", lit [(450, 300)], dark [(420, 480), (550, 350), (280, 430)];
    split_screen, "../examples/split_screen.rs", lit [(206, 467), (503, 170)], dark [(171, 493), (398, 418)];
    soft_shadows, "../examples/soft_shadows.rs", lit [(400, 470)], dark [(360, 486)];
    moving_sun, "../examples/moving_sun.rs", lit [(441, 399)], dark [(389, 486)];
    deferred, "../examples/deferred.rs", lit [(363, 399)], dark [(398, 486)];
    large_world, "../examples/large_world.rs", lit [(204, 349)], dark [(659, 419)];
    own_vertices, "../examples/own_vertices.rs", lit [(350, 440)], dark [(300, 345), (330, 480)];
    learn_wgpu, "../examples/learn_wgpu.rs", lit [(538, 86)], dark [(204, 440)];
}

/// Runs an example with the words of its command line.
type Run = fn(&[String]) -> Result<(), Box<dyn Error>>;

/// The picture of an example; `None`, said loudly, where there is no adapter.
fn drawn(name: &str, run: Run) -> Option<RgbImage> {
    let path = std::env::temp_dir().join(format!("{name}-{}.png", std::process::id()));
    if let Err(error) = run(&["--picture".to_owned(), path.display().to_string()]) {
        let required = std::env::var("UMBRAGE_REQUIRE_GPU").is_ok_and(|value| value == "1");
        assert!(!required, "UMBRAGE_REQUIRE_GPU=1, but {error}");
        eprintln!("SKIPPED: {error}");
        return None;
    }
    let picture = image::open(&path).expect("a picture").to_rgb8();
    std::fs::remove_file(&path).expect("it was written");
    assert!(run(&["--film".to_owned()]).is_err());
    Some(picture)
}

/// What is wrong, if the points that are lit are not clearly brighter than all in shadow.
fn fault(picture: &RgbImage, lit: &[(u32, u32)], dark: &[(u32, u32)]) -> Option<String> {
    let red = |points: &[(u32, u32)]| points.iter().map(|&(x, y)| u32::from(picture.get_pixel(x, y).0[0])).collect();
    let (lit, dark): (Vec<u32>, Vec<u32>) = (red(lit), red(dark));
    let is_right = 5 * lit.iter().min()? > 6 * dark.iter().max()?;
    (!is_right).then(|| format!("lit {lit:?}, dark {dark:?}"))
}
