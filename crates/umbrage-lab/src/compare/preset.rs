//! Known sets of techniques and shots, so that published numbers come out of one command.

use super::shots::Stride;

/// A known comparison: the defaults of a request.
#[derive(Debug)]
pub struct Preset {
    /// Name of the preset, as it is typed.
    pub name: &'static str,
    /// Description in a few words.
    pub about: &'static str,
    /// Techniques, in the grammar of [`crate::technique::text`]. Kinds that do not exist yet are
    /// left out with a note.
    pub techniques: &'static [&'static str],
    /// Settings of all techniques.
    pub with: &'static str,
    /// Names of the scenes.
    pub scenes: &'static [&'static str],
    /// Names of the cameras; empty for all.
    pub cameras: &'static [&'static str],
    /// Suns, in the grammar of `--suns`.
    pub suns: &'static [&'static str],
    /// Near plane in metres.
    pub near: Option<f64>,
    /// Far plane in metres.
    pub far: Option<f64>,
    /// Motion of cameras from frame to frame, for flicker.
    pub stride: Option<Stride>,
    /// Width and height in pixels, if not the default of all commands.
    pub size: Option<[u32; 2]>,
    /// True if pictures show each split in its own colour.
    pub tint: bool,
}

/// One map or slice, one nearest texel, one comparison, no blend, no fade, fitted to the slice
/// alone: the setting of the papers' measurements and of the project's series of techniques.
const PLAIN: &str = "preset=papers:filter=hard:blend=0:far-fade=0:fit=independent:stabilize=none";

/// [`PLAIN`] over the visible depths, for all techniques alike. Split planes lie where the boxes in
/// view promise the least error, and maps are selected by the area that they cover.
const VISIBLE: &str = "preset=papers:filter=hard:blend=0:far-fade=0:fit=independent:stabilize=none:range-fit=visible";

const LADDER: Preset = Preset {
    name: "ladder",
    about: "A ladder of techniques to compare with: error, memory and flicker",
    techniques: &[
        "ssm:1024",
        "ssm:2048",
        "pssm:2:512",
        "pssm:3:512",
        "pssm:4:512:lambda=0",
        "pssm:4:512:lambda=0.5",
        "pssm:4:512:lambda=0.9",
        "pssm:4:512:lambda=0.5:stabilize=exact",
        "pssm:4:1024:lambda=0.5",
        "pssm:4:1024:lambda=0.9",
        "pssm:4:1024:lambda=0.9:stabilize=exact",
    ],
    with: PLAIN,
    scenes: &["robot-war", "chessboard", "knights", "mining-terrain"],
    cameras: &[],
    suns: &["metrics"],
    near: Some(0.5),
    far: Some(500.0),
    stride: Some(Stride { metres: 0.5, turn: 0.0, zoom: 1.0, frames: 2 }),
    size: None,
    tint: false,
};

/// *Parallel-Split Shadow Maps*, Figure 8: SSM, PSM, LiSPSM, TSM (1024²), PSSM(2, 3, 4; 512²);
/// columns (a) to (d).
const FIGURE_8: Preset = Preset {
    name: "figure8",
    about: "The paper's Figure 8, columns (a) to (d)",
    techniques: &[
        "ssm:1024",
        "psm:1024",
        "lispsm:1024",
        "tsm:1024",
        "pssm:2:512:scheme=optimal:selection=map",
        "pssm:3:512:scheme=optimal:selection=map",
        "pssm:4:512:scheme=optimal:selection=map",
    ],
    with: VISIBLE,
    scenes: &["chessboard", "robot-war", "mining-terrain", "knights"],
    cameras: &["middle"],
    suns: &["own"],
    near: None,
    far: None,
    stride: None,
    size: None,
    tint: false,
};

/// Figure 8, column (e): light and eye nearly opposite; single maps of 2048², splits of 1024². The
/// cameras look 5° to 20° down and the sun stands 5° up before them, so that light and view oppose
/// each other by all but 10° to 25°.
const DUELING: Preset = Preset {
    name: "dueling",
    about: "The paper's Figure 8, column (e): the dueling frusta",
    techniques: &[
        "ssm:2048",
        "psm:2048",
        "lispsm:2048",
        "tsm:2048",
        "pssm:2:1024:scheme=optimal:selection=map",
        "pssm:3:1024:scheme=optimal:selection=map",
        "pssm:4:1024:scheme=optimal:selection=map",
    ],
    cameras: &["dueling"],
    suns: &["into@5"],
    ..FIGURE_8
};

/// The paper's techniques as the paper had them, then umbrage's default with maps of that size.
const TABLE: Preset = Preset {
    name: "table",
    about: "The first table of docs/results.md",
    techniques: &[
        "ssm:1024",
        "pssm:2:512",
        "pssm:3:512",
        "pssm:4:512",
        "pssm:4:512:fit=dependent:lambda=0.9",
        "pssm:4:512:fit=dependent:stabilize=exact",
        "pssm:4:512:preset=balanced:label=PSSM(4; 512²) balanced",
    ],
    with: PLAIN,
    cameras: &[],
    ..FIGURE_8
};

/// umbrage's presets, as an application gets them.
const PRESETS: Preset = Preset {
    name: "presets",
    about: "The presets of umbrage, the default second",
    techniques: &[
        "pssm:3:1024:preset=fast:label=fast",
        "pssm:4:1024:preset=balanced:label=balanced",
        "pssm:4:1024:preset=sharp:label=sharp",
        "pssm:4:1024:preset=still:label=still",
        "pssm:4:1024:preset=papers:label=papers",
        "pssm:4:720:preset=exact:label=exact",
    ],
    with: "",
    scenes: &["robot-war", "chessboard", "knights", "mining-terrain"],
    cameras: &[],
    ..FIGURE_8
};

/// umbrage's defaults under suns from overhead to the horizon, to look for acne and leaks.
const SUNS: Preset = Preset {
    name: "suns",
    about: "The defaults under suns from 80° to 5° above the horizon",
    techniques: &["pssm:4:1024:label=defaults"],
    with: "",
    scenes: &["robot-war", "chessboard", "knights", "mining-terrain"],
    cameras: &[],
    suns: &["80", "43", "20", "11", "5"],
    near: None,
    far: None,
    stride: None,
    size: None,
    tint: false,
};

/// *Practical Cascaded Shadow Maps*, Figure 4.1.9: the split by view depth and the first map that
/// contains the point, each split in its colour; spheres, as in the source, so that borders by map
/// are seen as their squares.
const SELECTION: Preset = Preset {
    name: "selection",
    about: "Splits chosen by view depth and by map, coloured: Figure 4.1.9 of Practical Cascaded Shadow Maps",
    techniques: &["pssm:3:512:selection=depth", "pssm:3:512:selection=map"],
    with: "preset=papers:filter=pcf3:blend=0:far-fade=0:stabilize=exact:range-fit=visible:scheme=log",
    scenes: &["robot-war", "knights"],
    cameras: &["dueling"],
    suns: &["into@11"],
    tint: true,
    ..FIGURE_8
};

/// *Parallel-Split Shadow Maps on Programmable GPUs*, Figure 10-8: a single map of 2048² beside
/// three splits of 1024² by the multipass method, with the book's own fit, λ = 0.5 and filter.
const GEMS_FIGURE: Preset = Preset {
    name: "gems-figure",
    about: "SSM(2048) beside PSSM(3; 1024): GPU Gems 3, Figure 10-8",
    techniques: &["ssm:2048", "pssm:3:1024:generation=multipass"],
    with: "preset=papers:filter=pcf2:blend=0:far-fade=0:fit=independent:stabilize=none",
    scenes: &["robot-war", "knights"],
    cameras: &["near"],
    ..FIGURE_8
};

/// Section 10.5 of that chapter: three and four splits of 1024² at 1280 × 1024 pixels, in a city
/// that has to be given.
const GEMS_RESULTS: Preset = Preset {
    name: "gems-results",
    about: "PSSM(3; 1024) and PSSM(4; 1024) at 1280 × 1024 pixels: GPU Gems 3, section 10.5, in a scene of your choice",
    techniques: &["pssm:3:1024", "pssm:4:1024"],
    scenes: &[],
    cameras: &[],
    size: Some([1280, 1024]),
    ..GEMS_FIGURE
};

/// *Practical Cascaded Shadow Maps*, Figures 4.1.2 to 4.1.6: flicker while the observer moves. A
/// frame is 0.15 m and 0.003 rad.
const STILLNESS: Preset = Preset {
    name: "stillness",
    about: "The kinds of stabilisation along a walk",
    techniques: &[
        "pssm:4:512:stabilize=none",
        "pssm:4:512:stabilize=exact",
        "pssm:4:512:stabilize=approximate",
        "pssm:4:512:stabilize=approximate:extent-levels=64",
    ],
    with: PLAIN,
    cameras: &["near", "middle"],
    stride: Some(Stride { metres: 0.15, turn: 0.171_887_338_539_246_97, zoom: 1.0, frames: 60 }),
    ..FIGURE_8
};

/// *Parallel-Split Variance Shadow Maps*, its five pictures: one shadow map and one variance shadow
/// map of 1024², four splits of 512², the same in colours, and as variance shadow maps.
const PSVSM: Preset = Preset {
    name: "psvsm",
    about: "The five pictures of parallel-split variance shadow maps",
    techniques: &[
        "ssm:1024:filter=pcf2:label=Shadow map (1024²)",
        "ssm:1024:filter=vsm:filter-width=0.5:label=Variance shadow map (1024²)",
        "pssm:4:512:filter=pcf2:label=Parallel-split (4; 512²)",
        "pssm:4:512:filter=pcf2:tint=true:label=The splits",
        "pssm:4:512:filter=vsm:filter-width=0.5:label=Parallel-split variance (4; 512²)",
    ],
    with: "preset=papers:far-fade=0:stabilize=none",
    scenes: &["robot-war", "chessboard", "mining-terrain"],
    cameras: &["middle"],
    ..FIGURE_8
};

/// Every filter on the same maps, under a sun of three degrees if the command asks for it.
const FILTERS: Preset = Preset {
    name: "filters",
    about: "Every filter on the same maps",
    techniques: &["pssm:4:1024:filter=each"],
    with: "",
    cameras: &["near"],
    ..FIGURE_8
};

/// All presets.
pub const ALL: [&Preset; 12] = [
    &LADDER,
    &FIGURE_8,
    &DUELING,
    &TABLE,
    &PRESETS,
    &STILLNESS,
    &SUNS,
    &PSVSM,
    &FILTERS,
    &SELECTION,
    &GEMS_FIGURE,
    &GEMS_RESULTS,
];

/// Returns the preset of this name.
#[must_use]
pub fn named(name: &str) -> Option<&'static Preset> {
    ALL.into_iter().find(|preset| preset.name == name)
}
