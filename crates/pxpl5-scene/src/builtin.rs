//! The built-in scenes. Code generates all of them, so they are the same on every host.

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
use crate::error::SceneError;
use crate::scene::Scene;

const NAMES: [(&str, &str); 10] = [
    (
        "aircraft",
        "A swept-wing jet of 100 triangles, few enough for Slats; whole and closed, on the fly-through of mig.",
    ),
    ("mig", "A swept-wing jet fighter of 417 triangles with moving control surfaces, seen from a fly-through."),
    (
        "molecules",
        "Sperm-whale myoglobin twice: 1,216 atoms, and its backbone as a ribbon of 2,620 triangles; with a water molecule.",
    ),
    ("head", "A human head as a closed, smooth surface of 59,592 triangles."),
    (
        "room",
        "A room of 4 triangles, whose walls are 2 m from the viewer and meet in corners 6 m away: world content wherever the head turns.",
    ),
    (
        "gallery",
        "A hall of 40 x 40 x 4 m with ten partitions, all of large quadrangles, and a closed path through it: 112 triangles to walk among.",
    ),
    ("gallery:full", "The same hall with 30 frames on its partitions and ten benches."),
    (
        FULL_SCREEN,
        "N triangles, each covering the whole screen of both eyes wherever the head turns; 12 make the trivial scene of TR94.",
    ),
    (
        TYPICAL,
        "N small triangles, each touching 1.3 regions on average, spread over the screen wherever the head turns.",
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
/// [`SceneError::UnknownScene`] with the nearest valid name, or [`SceneError::TriangleCount`].
pub fn builtin(name: &str) -> Result<Scene, SceneError> {
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
fn counted(name: &str) -> Result<Scene, SceneError> {
    match name.split_once(':') {
        Some(("full-screen", count)) => Ok(full_screen::scene(triangles(FULL_SCREEN, count, 1)?)),
        Some(("typical", count)) => Ok(typical::scene(triangles(TYPICAL, count, 1)?)),
        Some(("sphere", count)) => match triangles(SPHERE, count, LEAST_SPHERE_TRIANGLES)? {
            n if n.is_multiple_of(2) => Ok(sphere::scene(n)),
            n => Err(SceneError::TriangleCount { scene: SPHERE, expected: "even".to_owned(), found: n.to_string() }),
        },
        _ => Err(unknown(name)),
    }
}

/// Parses the number of triangles in a scene's name, and checks that it lies between `least` and [`MAX_TRIANGLES`].
fn triangles(scene: &'static str, count: &str, least: u32) -> Result<u32, SceneError> {
    let expected = || format!("from {least} to {MAX_TRIANGLES}");
    let number = count.parse().ok().filter(|n| (least..=MAX_TRIANGLES).contains(n));
    number.ok_or_else(|| SceneError::TriangleCount { scene, expected: expected(), found: excerpt(count) })
}

fn unknown(name: &str) -> SceneError {
    let found = excerpt(name);
    let lower = found.to_lowercase();
    let nearest = NAMES.iter().map(|(valid, _)| *valid).min_by_key(|valid| edits(&lower, valid));
    SceneError::UnknownScene {
        found,
        nearest: nearest.unwrap_or_default().to_owned(),
        valid: NAMES.map(|(valid, _)| valid).join(", "),
    }
}

/// Cuts a name to 40 characters, so that an error message and the search for the nearest name stay short. All valid
/// names are shorter.
fn excerpt(name: &str) -> String {
    name.chars().take(40).collect()
}

/// Returns the Levenshtein distance of two words: the number of characters to insert, delete or replace to turn one
/// word into the other.
fn edits(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.chars().collect();
    // `row` holds the distances from the first i characters of `from` to every beginning of `to`.
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (i, a) in from.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &b) in to.iter().enumerate() {
            let replaced = diagonal + usize::from(a != b);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[to.len()]
}

#[cfg(test)]
mod tests {
    use super::edits;

    #[test]
    fn the_distance_of_words_counts_single_edits() {
        assert_eq!(edits("kitten", "sitting"), 3); // Levenshtein's own textbook pair
        assert_eq!(edits("", "mig"), 3);
        assert_eq!(edits("head", "head"), 0);
    }
}
