//! Readers never panic, whatever the bytes, and every accepted file is a valid scene.

use proptest::prelude::*;
use pxpl5_scene::{Format, Scene, from_bytes};

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nvn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1 4\nf -1 -2 -3\n";
const PDB: &str = "\
ATOM      1  N   SER A   1      11.000  -2.000   0.500  1.00  0.00           N  \n\
HETATM    2 FE   HEM A   2      12.000   1.000   0.500  1.00  0.00          FE  \n\
ENDMDL\n";

fn ply(encoding: &str) -> Vec<u8> {
    let header = format!(
        "ply\nformat {encoding} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n\
         element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    );
    let mut file = header.into_bytes();
    if encoding == "ascii" {
        file.extend(b"0 0 0 0 0 1 9\n1 0 0 0 0 1 9\n0 1 0 0 0 1 9\n3 0 1 2\n4 0 1 2 0\n");
        return file;
    }
    let word = if encoding.contains("big") { u32::to_be_bytes } else { u32::to_le_bytes };
    for vertex in [[0.0_f32, 0.0, 0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0, 0.0, 1.0]] {
        vertex.iter().for_each(|x| file.extend(word(x.to_bits())));
        file.push(9);
    }
    for face in [&[0, 1, 2][..], &[0, 1, 2, 0]] {
        file.push(face.len() as u8);
        face.iter().for_each(|&corner| file.extend(word(corner)));
    }
    file
}

fn samples() -> Vec<(Format, Vec<u8>)> {
    let plys = ["ascii", "binary_little_endian", "binary_big_endian"].map(|e| (Format::Ply, ply(e)));
    let texts = [(Format::Obj, OBJ.into()), (Format::Pdb, PDB.into())];
    plys.into_iter().chain(texts).collect()
}

/// A random change of a file: a byte is replaced, inserted or removed, the end is cut off, or a piece is repeated.
#[derive(Debug, Clone)]
enum Damage {
    Replace(prop::sample::Index, u8),
    Insert(prop::sample::Index, Vec<u8>),
    Remove(prop::sample::Index),
    Cut(prop::sample::Index),
    Repeat(prop::sample::Index, prop::sample::Index),
}

fn damage() -> impl Strategy<Value = Damage> {
    let place = any::<prop::sample::Index>;
    let word = prop_oneof!["[0-9 \n/.e-]{1,12}", "nan|inf|-1|4294967296|1e38|list uint double q\n"];
    prop_oneof![
        (place(), any::<u8>()).prop_map(|(i, byte)| Damage::Replace(i, byte)),
        (place(), word.prop_map(String::into_bytes)).prop_map(|(i, word)| Damage::Insert(i, word)),
        place().prop_map(Damage::Remove),
        place().prop_map(Damage::Cut),
        (place(), place()).prop_map(|(i, j)| Damage::Repeat(i, j)),
    ]
}

fn apply(file: &mut Vec<u8>, damage: Damage) {
    if file.is_empty() {
        return;
    }
    let length = file.len();
    match damage {
        Damage::Replace(i, byte) => file[i.index(length)] = byte,
        Damage::Insert(i, word) => {
            let i = i.index(length);
            file.splice(i..i, word);
        }
        Damage::Remove(i) => {
            file.remove(i.index(length));
        }
        Damage::Cut(i) => file.truncate(i.index(length)),
        Damage::Repeat(i, j) => {
            let i = i.index(length);
            let j = j.index(length);
            file.extend_from_within(i.min(j)..i.max(j));
        }
    }
}

/// Checks the scene's own rules again for a scene that a reader has built.
fn assert_sound(scene: Scene) {
    let drawn = scene.triangles().len() + scene.spheres().len();
    assert!(drawn > 0);
    let reach = scene.vertices().iter().map(|v| v.position.length());
    assert!(reach.fold(0.0, f32::max).is_finite());
    Scene::new(scene.into_parts()).expect("a reader's scene is sound");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_damaged_file_causes_a_panic(which in 0..5_usize, damages in prop::collection::vec(damage(), 1..6)) {
        let (format, mut file) = samples().swap_remove(which);
        damages.into_iter().for_each(|d| apply(&mut file, d));
        if let Ok(scene) = from_bytes(&file, format, "damaged") {
            assert_sound(scene);
        }
    }

    #[test]
    fn no_bytes_cause_a_panic(which in 0..3_usize, bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let format = [Format::Ply, Format::Obj, Format::Pdb][which];
        if let Ok(scene) = from_bytes(&bytes, format, "noise") {
            assert_sound(scene);
        }
    }
}

#[test]
fn the_undamaged_files_are_read() {
    for (format, file) in samples() {
        assert_sound(from_bytes(&file, format, "sample").unwrap_or_else(|error| panic!("{error}")));
    }
}
