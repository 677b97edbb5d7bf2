//! The list of jobs: the command of each, its limit of time, and the file of its results.

/// Subcommand of `umbrage` that measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `umbrage compare … --json FILE`.
    Compare,
    /// `umbrage bench … --json FILE`.
    Bench,
}

/// Size of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// All measurements of docs/results.md.
    Full,
    /// The smallest job with every key. It proves that the jobs and the page fit each other; its
    /// results mean nothing.
    Tiny,
}

/// One run of `umbrage`.
#[derive(Clone, Copy, Debug)]
pub struct Job {
    /// Name of the kept file, `docs/results/NAME.json`.
    pub name: &'static str,
    /// Subcommand of the job.
    pub kind: Kind,
    /// Options at either scale.
    options: &'static str,
    /// Further options for docs/results.md.
    full: &'static str,
    /// Options in place of `full`, to prove the job.
    tiny: &'static str,
    /// Minutes that the full job may take on two cores and Mesa's software driver. A test bounds
    /// the sum.
    pub minutes: u32,
}

impl Job {
    /// Returns the words after `umbrage`, without the file of the results.
    pub fn words(&self, scale: Scale) -> Vec<&'static str> {
        let kind = match self.kind {
            Kind::Compare => "compare --image-metrics off",
            Kind::Bench => "bench",
        };
        let by_scale = match scale {
            Scale::Full => self.full,
            Scale::Tiny => self.tiny,
        };
        [kind, self.options, by_scale].into_iter().flat_map(str::split_whitespace).collect()
    }

    /// Returns the command line, as docs/results.md shows it.
    pub fn shown(&self, scale: Scale) -> String {
        format!("umbrage {}", self.words(scale).join(" "))
    }
}

/// Minutes that all jobs together may take.
#[cfg(test)]
const MOST_MINUTES: u32 = 25;

/// Options for half the size that the view rule was made for, and half its edges: a quarter of the
/// time, and means that agree.
const HALF_SIZE: &str = "--size 400x300 --least-edges 1000";

const ONE_VIEW: &str = "chessboard --camera middle --size 96x72 --least-edges 1";

/// All jobs, in the order of the page.
pub const JOBS: [Job; 15] = [
    Job {
        name: "presets",
        kind: Kind::Compare,
        options: "--preset presets",
        full: "--size 400x300 --least-edges 500",
        tiny: ONE_VIEW,
        minutes: 2,
    },
    Job {
        name: "presets-walking",
        kind: Kind::Compare,
        options: "robot-war knights --preset presets --camera near,middle",
        full: "--size 400x300 --least-edges 500 --frames 8 --step 0.15",
        tiny: "--size 96x72 --least-edges 1 --frames 2 --step 0.15",
        minutes: 2,
    },
    Job {
        name: "presets-turning",
        kind: Kind::Compare,
        options: "robot-war knights --preset presets --camera near,middle",
        full: "--size 400x300 --least-edges 500 --frames 8 --turn 0.3",
        tiny: "--size 96x72 --least-edges 1 --frames 2 --turn 0.3",
        minutes: 2,
    },
    Job {
        name: "table",
        kind: Kind::Compare,
        options: "--preset table --with fit=dependent",
        full: HALF_SIZE,
        tiny: ONE_VIEW,
        minutes: 1,
    },
    Job {
        name: "figure8",
        kind: Kind::Compare,
        options: "--preset figure8",
        full: HALF_SIZE,
        tiny: ONE_VIEW,
        minutes: 1,
    },
    Job {
        name: "figure8-dependent",
        kind: Kind::Compare,
        options: "--preset figure8 --with fit=dependent",
        full: HALF_SIZE,
        tiny: ONE_VIEW,
        minutes: 1,
    },
    Job {
        name: "dueling",
        kind: Kind::Compare,
        options: "--preset dueling",
        full: HALF_SIZE,
        tiny: "chessboard --size 96x72 --least-edges 1",
        minutes: 1,
    },
    Job {
        name: "dueling-dependent",
        kind: Kind::Compare,
        options: "--preset dueling --with fit=dependent",
        full: HALF_SIZE,
        tiny: "chessboard --size 96x72 --least-edges 1",
        minutes: 1,
    },
    Job {
        name: "ladder-city",
        kind: Kind::Compare,
        options: "assets/city_candela.glb --preset ladder --path assets/city_candela.path.json",
        full: "--frames 3 --size 400x300 --least-edges 1000",
        tiny: "--frames 1 --suns own --size 96x72 --least-edges 1",
        minutes: 1,
    },
    Job {
        name: "suns",
        kind: Kind::Compare,
        options: "--preset suns",
        full: HALF_SIZE,
        tiny: "chessboard --camera middle --suns 80,5 --size 96x72 --least-edges 1",
        minutes: 2,
    },
    Job {
        name: "suns-city",
        kind: Kind::Compare,
        options: "assets/city_candela.glb --preset suns --path assets/city_candela.path.json",
        full: "--frames 3 --suns own,80,43,20,11,5 --size 400x300 --least-edges 1000",
        tiny: "--frames 1 --suns own --size 96x72 --least-edges 1",
        minutes: 1,
    },
    Job {
        name: "stillness",
        kind: Kind::Compare,
        options: "--preset stillness --shadow-range 1..400",
        full: "robot-war chessboard --camera near --size 400x300 --least-edges 400 --frames 24",
        tiny: "chessboard --camera near --size 96x72 --least-edges 1 --frames 3",
        minutes: 2,
    },
    Job {
        name: "filters-soft",
        kind: Kind::Compare,
        options: "--camera near --sun-angle 3 --techniques pssm:4:1024:filter=each",
        full: "robot-war chessboard knights mining-terrain --size 320x240 --least-edges 300",
        tiny: "chessboard --size 64x48 --least-edges 1",
        minutes: 2,
    },
    Job {
        name: "bench",
        kind: Kind::Bench,
        options: "--paths off --objects 10",
        full: "--rounds 3",
        tiny: "chessboard --rounds 1 --size 96x72",
        minutes: 2,
    },
    Job {
        name: "bench-filters",
        kind: Kind::Bench,
        options: "--filters",
        full: "--rounds 3 --size 480x360",
        tiny: "chessboard --rounds 1 --size 64x48",
        minutes: 2,
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_whole_run_is_bounded() {
        let sum: u32 = JOBS.iter().map(|job| job.minutes).sum();
        assert!(sum <= MOST_MINUTES, "{sum} minutes");
    }

    #[test]
    fn names_are_file_names_and_unique() {
        for (index, job) in JOBS.iter().enumerate() {
            assert!(job.name.chars().all(|letter| letter.is_ascii_lowercase() || "-0123456789".contains(letter)));
            assert!(JOBS[..index].iter().all(|earlier| earlier.name != job.name), "{}", job.name);
        }
    }
}
