//! Writes the room with lamps that the tests judge, as binary glTF: `cargo run -p umbrage-tests
//! --example room -- room.glb`.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("give the file to write, for example room.glb")?;
    std::fs::write(path, umbrage_scene::export_glb(&umbrage_tests::room::room())?)?;
    Ok(())
}
