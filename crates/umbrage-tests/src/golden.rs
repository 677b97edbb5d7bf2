//! Reference images: small PNG files beside the tests. Tests compare images with them, show
//! differences, and replace them only on demand.

use std::{
    env, fs, io,
    path::{Path, PathBuf},
};

use image::{
    DynamicImage, ImageEncoder, ImageError,
    codecs::png::{CompressionType, FilterType, PngEncoder},
};

use crate::compare::{Golden, Incomparable, Verdict, compare, difference};

/// Largest size of one reference in bytes. References stay in every clone for ever.
pub const LARGEST: u64 = 8 * 1024;
/// Largest size of all references in bytes.
pub const LARGEST_TOTAL: u64 = 96 * 1024;
/// Environment variable that replaces references if it is 1; `cargo xtask bless` sets it.
pub const BLESS: &str = "UMBRAGE_BLESS";

/// Treatment of an image that differs from its reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Fails.
    Check,
    /// Replaces the reference.
    Bless,
}

impl Mode {
    /// Reads the mode from the environment variable [`BLESS`].
    #[must_use]
    pub fn from_env() -> Self {
        if env::var(BLESS).is_ok_and(|value| value == "1") { Self::Bless } else { Self::Check }
    }
}

/// A folder of references, `NAME.png`.
#[derive(Clone, Debug)]
pub struct Goldens {
    /// Folder of the references.
    pub references: PathBuf,
    /// Folder of `NAME.expected.png`, `NAME.actual.png` and `NAME.difference.png` of a failure.
    pub failures: PathBuf,
    /// Treatment of differing images.
    pub mode: Mode,
}

/// Reason why an image does not match its reference.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Failure {
    /// There is no reference.
    #[error("{name}: there is no reference image; look at {}, then run `cargo xtask bless`", actual.display())]
    Missing {
        /// Name of the reference.
        name: String,
        /// Path of the image, which could become the reference.
        actual: PathBuf,
    },
    /// The image differs from the reference.
    #[error("{name}: {verdict}; look at {name}.*.png in {}", folder.display())]
    Differs {
        /// Name of the reference.
        name: String,
        /// Measured differences.
        verdict: Verdict,
        /// Folder of the expected image, the actual one and their difference.
        folder: PathBuf,
    },
    /// The image has another size or kind.
    #[error("{name}: {reason}; look at {name}.*.png in {}", folder.display())]
    Incomparable {
        /// Name of the reference.
        name: String,
        /// Difference of size or kind.
        reason: Incomparable,
        /// Folder of the expected and the actual image.
        folder: PathBuf,
    },
    /// The image is too large to be kept as a reference.
    #[error("{name}: {bytes} bytes of PNG, more than the {LARGEST} that a reference may have; draw it smaller")]
    TooLarge {
        /// Name of the reference.
        name: String,
        /// Size of the image's file in bytes.
        bytes: u64,
    },
    /// The reference is not an 8-bit PNG of the two kinds.
    #[error("{}: neither a mask (8-bit grey and alpha) nor a picture (8-bit RGB) but {found}", path.display())]
    Format {
        /// Path of the reference.
        path: PathBuf,
        /// Format that was found.
        found: String,
    },
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A PNG cannot be read or written.
    #[error("{}: {source}", path.display())]
    Image {
        /// Path of the PNG.
        path: PathBuf,
        /// Error of the decoder or encoder.
        source: ImageError,
    },
}

impl Goldens {
    /// Compares an image with the reference of that name. An image that differs is written to
    /// [`Goldens::failures`], or becomes the reference in [`Mode::Bless`]. A reference with the
    /// same pixels is left alone.
    ///
    /// # Errors
    /// [`Failure`], whose message says where to look.
    pub fn check(&self, name: &str, actual: &Golden) -> Result<(), Failure> {
        self.forget(name)?;
        let reference = self.reference(name);
        let expected = if exists(&reference)? { Some(read(&reference)) } else { None };
        if self.mode == Mode::Bless {
            // Whatever is there, readable or not, is replaced.
            return match expected {
                Some(Ok(expected)) if expected == *actual => Ok(()),
                _ => self.bless(name, actual),
            };
        }
        let Some(expected) = expected.transpose()? else {
            let actual = self.show(name, "actual", actual)?;
            return Err(Failure::Missing { name: name.to_owned(), actual });
        };
        let compared = compare(&expected, actual);
        if compared.is_ok_and(|verdict| verdict.is_same()) {
            return Ok(());
        }
        self.show(name, "expected", &expected)?;
        self.show(name, "actual", actual)?;
        if let Some(difference) = difference(&expected, actual) {
            self.show(name, "difference", &Golden::Picture(difference))?;
        }
        let (name, folder) = (name.to_owned(), self.failures.clone());
        Err(match compared {
            Ok(verdict) => Failure::Differs { name, verdict, folder },
            Err(reason) => Failure::Incomparable { name, reason, folder },
        })
    }

    /// Checks the folder as a whole. Returns complaints about files that no image of `names` is
    /// compared with, and about files that are too large.
    ///
    /// # Errors
    /// [`Failure::Io`] if the folder cannot be read.
    pub fn audit(&self, names: &[&str]) -> Result<Vec<String>, Failure> {
        let mut complaints = Vec::new();
        let mut total = 0;
        let at_folder = |source| Failure::Io { path: self.references.clone(), source };
        for entry in fs::read_dir(&self.references).map_err(at_folder)? {
            let entry = entry.map_err(at_folder)?;
            let bytes = entry.metadata().map_err(at_folder)?.len();
            let file = entry.file_name().to_string_lossy().into_owned();
            total += bytes;
            if !file.strip_suffix(".png").is_some_and(|name| names.contains(&name)) {
                complaints.push(format!("{file}: no image is compared with it; delete it"));
            }
            if bytes > LARGEST {
                complaints.push(format!("{file}: {bytes} bytes, more than {LARGEST}; draw it smaller"));
            }
        }
        if total > LARGEST_TOTAL {
            complaints.push(format!("all references: {total} bytes, more than {LARGEST_TOTAL}; leave some out"));
        }
        Ok(complaints)
    }

    /// Reads the reference of that name.
    ///
    /// # Errors
    /// [`Failure`] if it is missing or not a PNG of the two kinds.
    pub fn read(&self, name: &str) -> Result<Golden, Failure> {
        read(&self.reference(name))
    }

    fn reference(&self, name: &str) -> PathBuf {
        self.references.join(format!("{name}.png"))
    }

    fn bless(&self, name: &str, actual: &Golden) -> Result<(), Failure> {
        let path = self.reference(name);
        let png = encode(&path, actual)?;
        let bytes = png.len() as u64;
        if bytes > LARGEST {
            self.show(name, "actual", actual)?;
            return Err(Failure::TooLarge { name: name.to_owned(), bytes });
        }
        write(&path, &png)
    }

    /// Deletes the files that an earlier failure has left.
    fn forget(&self, name: &str) -> Result<(), Failure> {
        for part in ["expected", "actual", "difference"] {
            let path = self.failures.join(format!("{name}.{part}.png"));
            match fs::remove_file(&path) {
                Err(source) if source.kind() != io::ErrorKind::NotFound => return Err(Failure::Io { path, source }),
                _ => {}
            }
        }
        Ok(())
    }

    fn show(&self, name: &str, part: &str, image: &Golden) -> Result<PathBuf, Failure> {
        let path = self.failures.join(format!("{name}.{part}.png"));
        write(&path, &encode(&path, image)?)?;
        Ok(path)
    }
}

fn exists(path: &Path) -> Result<bool, Failure> {
    path.try_exists().map_err(|source| Failure::Io { path: path.to_owned(), source })
}

fn read(path: &Path) -> Result<Golden, Failure> {
    match image::open(path).map_err(|source| Failure::Image { path: path.to_owned(), source })? {
        DynamicImage::ImageLumaA8(mask) => Ok(Golden::Mask(mask)),
        DynamicImage::ImageRgb8(picture) => Ok(Golden::Picture(picture)),
        other => Err(Failure::Format { path: path.to_owned(), found: format!("{:?}", other.color()) }),
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let at_path = |source| Failure::Io { path: path.to_owned(), source };
    path.parent().map_or(Ok(()), fs::create_dir_all).map_err(at_path)?;
    fs::write(path, bytes).map_err(at_path)
}

/// Encodes an image as the smallest PNG.
fn encode(path: &Path, image: &Golden) -> Result<Vec<u8>, Failure> {
    let (bytes, color): (&[u8], _) = match image {
        Golden::Mask(mask) => (mask.as_raw(), image::ExtendedColorType::La8),
        Golden::Picture(picture) => (picture.as_raw(), image::ExtendedColorType::Rgb8),
    };
    // Masks are flat and repeat themselves; pictures have gradients.
    let filter = match image {
        Golden::Mask(_) => FilterType::NoFilter,
        Golden::Picture(_) => FilterType::Adaptive,
    };
    let [width, height] = image.size();
    let mut png = Vec::new();
    PngEncoder::new_with_quality(&mut png, CompressionType::Best, filter)
        .write_image(bytes, width, height, color)
        .map_err(|source| Failure::Image { path: path.to_owned(), source })?;
    Ok(png)
}
