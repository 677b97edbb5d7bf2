//! The example runs, and its picture shows light and shadow.

#[path = "../examples/hello_shadows/main.rs"]
#[allow(dead_code, reason = "the example's own `main` is not called")]
mod hello_shadows;

#[test]
fn hello_shadows_writes_a_picture() {
    let path = std::env::temp_dir().join(format!("hello_shadows-{}.png", std::process::id()));
    let arguments = ["--picture".to_owned(), path.display().to_string()];
    if let Err(error) = hello_shadows::run(&arguments) {
        let required = std::env::var("UMBRAGE_REQUIRE_GPU").is_ok_and(|value| value == "1");
        assert!(!required, "UMBRAGE_REQUIRE_GPU=1, but {error}");
        eprintln!("SKIPPED: {error}");
        return;
    }
    let picture = image::open(&path).expect("a picture").to_rgb8();
    std::fs::remove_file(&path).expect("it was written");
    // The plain is grey: bright in the sun, dark and blue in shadow.
    let plain = |bright: bool| {
        let is = |pixel: &&image::Rgb<u8>| if bright { pixel.0[0] > 170 } else { pixel.0[0] < 110 && pixel.0[2] < 150 };
        picture.pixels().filter(is).count()
    };
    let all = (picture.width() * picture.height()) as usize;
    assert!(plain(true) > all / 5 && plain(false) > all / 50, "{} lit, {} dark of {all}", plain(true), plain(false));
    assert!(hello_shadows::run(&["--film".to_owned()]).is_err());
}
