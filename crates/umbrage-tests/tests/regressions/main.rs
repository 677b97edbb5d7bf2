//! What must not change unnoticed: pictures, masks and scores of every technique in the four
//! worlds. One binary, so that every world is built once.

mod acne;
mod ceilings;
mod field;
mod foregrounds;
mod goldens;
mod paths;
mod robot_war;
mod rooms;
mod stillness;
