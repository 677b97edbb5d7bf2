//! Reference images: small PNG files beside the tests, compared, shown where they differ, and
//! replaced only on demand.

use std::{
    env, fs, io,
    path::{Path, PathBuf},
};

use image::{
    DynamicImage, ImageEncoder, ImageError,
    codecs::png::{CompressionType, FilterType, PngEncoder},
};

use crate::compare::{Golden, Incomparable, Verdict, compare, difference};

/// The most bytes of one reference. They are in everybody's clone for ever.
pub const LARGEST: u64 = 8 * 1024;
/// The most bytes of all of them.
pub const LARGEST_TOTAL: u64 = 96 * 1024;
/// References are replaced where this environment variable is 1; `cargo xtask bless` sets it.
pub const BLESS: &str = "UMBRAGE_BLESS";

/// What to do with an image that differs from its reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Say no.
    Check,
    /// Replace the reference.
    Bless,
}

impl Mode {
    /// As [`BLESS`] has it.
    #[must_use]
    pub fn from_env() -> Self {
        if env::var(BLESS).is_ok_and(|value| value == "1") { Self::Bless } else { Self::Check }
    }
}

/// A folder of references, `NAME.png`.
#[derive(Clone, Debug)]
pub struct Goldens {
    /// Where they lie.
    pub references: PathBuf,
    /// Where `NAME.expected.png`, `NAME.actual.png` and `NAME.difference.png` of a failure go.
    pub failures: PathBuf,
    /// What to do.
    pub mode: Mode,
}

/// Why an image is not its reference.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Failure {
    /// Nothing to compare with.
    #[error("{name}: there is no reference image; look at {}, then run `cargo xtask bless`", actual.display())]
    Missing {
        /// The reference's.
        name: String,
        /// What would become the reference.
        actual: PathBuf,
    },
    /// It looks otherwise.
    #[error("{name}: {verdict}; look at {name}.*.png in {}", folder.display())]
    Differs {
        /// The reference's.
        name: String,
        /// By how much.
        verdict: Verdict,
        /// Where expected, actual and difference lie.
        folder: PathBuf,
    },
    /// It is something else.
    #[error("{name}: {reason}; look at {name}.*.png in {}", folder.display())]
    Incomparable {
        /// The reference's.
        name: String,
        /// What differs.
        reason: Incomparable,
        /// Where expected and actual lie.
        folder: PathBuf,
    },
    /// It would weigh too much to keep.
    #[error("{name}: {bytes} bytes of PNG, more than the {LARGEST} that a reference may have; draw it smaller")]
    TooLarge {
        /// The reference's.
        name: String,
        /// What it has.
        bytes: u64,
    },
    /// The reference is no 8-bit PNG of the two kinds.
    #[error("{}: neither a mask (8-bit grey and alpha) nor a picture (8-bit RGB) but {found}", path.display())]
    Format {
        /// The reference.
        path: PathBuf,
        /// What it is.
        found: String,
    },
    /// A file.
    #[error("{}: {source}", path.display())]
    Io {
        /// Which.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A PNG.
    #[error("{}: {source}", path.display())]
    Image {
        /// Which.
        path: PathBuf,
        /// Why.
        source: ImageError,
    },
}

impl Goldens {
    /// Compares an image with the reference of that name. What differs is shown in
    /// [`Goldens::failures`], or becomes the reference in [`Mode::Bless`]; a reference that has the
    /// very same pixels is left alone.
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

    /// What is wrong with the folder as a whole: files that no image of `names` is compared with,
    /// files that weigh too much.
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

    /// The reference of that name, as it was accepted.
    ///
    /// # Errors
    /// [`Failure`] if it is missing or no PNG of ours.
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

    /// Deletes what an earlier failure has left.
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

/// As small as it gets.
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
