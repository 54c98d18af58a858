//! The built-in scenes. Code generates these scenes, so the scenes are the same on every computer.

mod aircraft;
mod full_screen;
mod gallery;
mod head;
mod head_shape;
mod mig;
mod molecules;
mod one_structure;
mod room;
mod solid;
mod sphere;
mod typical;

use crate::config::{LEAST_SPHERE_TRIANGLES, MAX_TRIANGLES};
use crate::scene::Scene;
use pxpl5_sim::parameters::SettingError;

const NAMES: [(&str, &str); 10] = [
    (
        "aircraft",
        "A swept-wing jet of 100 triangles: a closed surface that Slats can draw in time, on the fly-through of mig.",
    ),
    ("mig", "A swept-wing jet fighter of 417 triangles with moving control surfaces, seen from a fly-through."),
    (
        "molecules",
        "Sperm-whale myoglobin twice: 1,216 atoms, and its backbone as a ribbon of 2,620 triangles; with a water molecule.",
    ),
    ("head", "A human head as a closed, smooth surface of 59,592 triangles."),
    (
        "room",
        "A room of 4 triangles, whose walls are 2 m from the viewer and meet in corners 6 m away. It fills the view in every direction.",
    ),
    (
        "gallery",
        "A hall of 40 x 40 x 4 m with ten partitions, all of large quadrangles, and a closed path through it: 112 triangles.",
    ),
    ("gallery:full", "The same hall with 30 frames on its partitions and ten benches."),
    (
        FULL_SCREEN,
        "N triangles that move with the head, each covering the whole screen of both eyes; 12 make the trivial scene of TR94.",
    ),
    (
        TYPICAL,
        "N small triangles that move with the head, each touching 1.3 regions on average, spread over the screen.",
    ),
    (SPHERE, "A ball as a closed, smooth surface of N triangles; N is even."),
];

const FULL_SCREEN: &str = "full-screen:N";
const TYPICAL: &str = "typical:N";
const SPHERE: &str = "sphere:N";

/// Returns the names of all built-in scenes, each with a one-sentence description. In a name, N stands for a number of
/// triangles up to [`MAX_TRIANGLES`].
#[must_use]
pub fn names() -> &'static [(&'static str, &'static str)] {
    &NAMES
}

/// Generates the built-in scene of this name, for example `"mig"` or `"full-screen:12"`.
///
/// # Errors
///
/// Returns [`SettingError`] with the nearest valid name, or with the allowed number of triangles.
pub fn builtin(name: &str) -> Result<Scene, SettingError> {
    match name {
        "aircraft" => Ok(aircraft::scene()),
        "mig" => Ok(mig::scene()),
        "molecules" => Ok(molecules::scene()),
        "head" => Ok(head::scene()),
        "room" => Ok(room::scene()),
        "gallery" => Ok(gallery::scene(false)),
        "gallery:full" => Ok(gallery::scene(true)),
        _ => counted(name),
    }
}

/// Generates a scene whose name contains a number of triangles, such as `sphere:80`.
fn counted(name: &str) -> Result<Scene, SettingError> {
    match name.split_once(':') {
        Some(("full-screen", count)) => Ok(full_screen::scene(triangles(FULL_SCREEN, count, 1)?)),
        Some(("typical", count)) => Ok(typical::scene(triangles(TYPICAL, count, 1)?)),
        Some(("sphere", count)) => match triangles(SPHERE, count, LEAST_SPHERE_TRIANGLES)? {
            n if n.is_multiple_of(2) => Ok(sphere::scene(n)),
            n => Err(wrong_count(SPHERE, "even", &n.to_string())),
        },
        _ => Err(unknown(name)),
    }
}

/// Parses the number of triangles in a scene's name, and checks that it lies between `least` and [`MAX_TRIANGLES`].
fn triangles(scene: &'static str, count: &str, least: u32) -> Result<u32, SettingError> {
    let number = count.parse().ok().filter(|n| (least..=MAX_TRIANGLES).contains(n));
    number.ok_or_else(|| wrong_count(scene, &format!("from {least} to {MAX_TRIANGLES}"), &excerpt(count)))
}

fn wrong_count(scene: &str, expected: &str, found: &str) -> SettingError {
    SettingError::value(&format!("scene {scene}"), format_args!("N {expected}"), format_args!("{found:?}"))
}

fn unknown(name: &str) -> SettingError {
    SettingError::unknown("scene", &excerpt(name), NAMES.iter().map(|(valid, _)| *valid))
}

/// Cuts a name to 40 characters, so that an error message and the search for the nearest name stay short. All valid
/// names are shorter.
fn excerpt(name: &str) -> String {
    name.chars().take(40).collect()
}
