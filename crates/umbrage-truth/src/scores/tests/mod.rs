//! Every score where its value is known, and where it has to say no.

mod acne;
mod beside;
mod flicker;
mod footprint;
mod frames;
mod hard;
mod seams;
mod soft;
