//! Lists of the pipelines, scenes, displays and motions that a visitor of the web page can choose.

use serde_json::{Value, json};

/// Motions of the head that need no recorded file, each with a description. The empty name stands for the motion that
/// belongs to the scene.
const MOTIONS: [(&str, &str); 8] = [
    ("", "the scene's own motion, followed without delay"),
    ("still", "a head that stands still"),
    ("pan:100", "a turn at 100 degrees a second"),
    ("sine:20:0.5", "to and fro by 20 degrees at half a hertz"),
    ("recorded:vive-tracked", "a real head: a user of an HTC Vive walks and looks around, 29 s"),
    ("recorded:vive-dev", "a real head: a standing user of the same headset, 9 s"),
    ("synthetic:1", "computed, not recorded: a viewer who looks around as fast as recorded users of headsets do"),
    ("live.csv", "your own: drag across a picture while the machine runs"),
];

pub(crate) fn catalog() -> Value {
    let registry = pxpl5_lab::registry();
    let pipelines = registry.pipelines().iter();
    let scenes = pxpl5_scene::names().iter();
    json!({
        "trackers": names(pxpl5_lab::TRACKERS),
        "predictors": names(pxpl5_lab::PREDICTORS),
        "pipelines": pipelines.map(|entry| json!({"name": entry.name, "about": entry.about})).collect::<Vec<_>>(),
        "scenes": scenes.map(|(name, about)| json!({"name": example(name), "about": about})).collect::<Vec<_>>(),
        "displays": registry.displays().iter().map(|entry| entry.name).collect::<Vec<_>>(),
        "motions": MOTIONS.iter().map(|(name, about)| json!({"name": name, "about": about})).collect::<Vec<_>>(),
    })
}

/// Splits an English list, such as `optical, fastrak or ideal`, into the single names.
fn names(list: &str) -> Vec<&str> {
    list.split([',', ' ']).filter(|word| !word.is_empty() && *word != "or").collect()
}

/// Returns a scene's name in which an example number of triangles replaces the letter `N`.
fn example(name: &str) -> String {
    let (family, count) = name.split_once(':').unwrap_or((name, ""));
    match count {
        "N" if family == "full-screen" => "full-screen:12".to_owned(),
        "N" => format!("{family}:100"),
        _ => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_listed_tracker_and_predictor_exists() {
        let all = catalog();
        let of = |key: &str| all[key].as_array().expect("a list").clone();
        assert!(of("trackers").len() > 3 && of("predictors").len() > 3);
        of("trackers")
            .iter()
            .for_each(|name| assert!(pxpl5_lab::tracker(name.as_str().expect("text")).is_ok(), "{name}"));
        of("predictors")
            .iter()
            .for_each(|name| assert!(pxpl5_lab::predictor(name.as_str().expect("text")).is_ok(), "{name}"));
    }

    #[test]
    fn every_scene_of_the_list_can_be_built() {
        let all = catalog();
        let names =
            all["scenes"].as_array().expect("a list").iter().map(|scene| scene["name"].as_str().expect("a name"));
        assert!(names.clone().count() > 5);
        names.for_each(|name| assert!(pxpl5_scene::builtin(name).is_ok(), "{name}"));
    }
}
