//! The memory limit of readers, measured by a counting allocator: at most seven times the file, plus 4 MiB.

#![allow(unsafe_code, reason = "a counting allocator cannot be written without")]

use pxpl5_sim::parameters::{FileError, FileErrorKind};
use std::alloc::{GlobalAlloc, Layout, System};
use std::fmt::Write;
use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use pxpl5_scene::config::{MEMORY_FLOOR_BYTES, MEMORY_TIMES_FILE};
use pxpl5_scene::load;

/// An allocator that counts the memory in use and its maximum. A growing list is moved page by page, as the system's
/// allocator does with large lists.
struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);
/// A lock that lets only one test run at a time. The memory of parallel tests would be counted too.
static ALONE: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn take(bytes: usize) {
    let held = HELD.fetch_add(bytes, Ordering::SeqCst) + bytes;
    MOST.fetch_max(held, Ordering::SeqCst);
}

// SAFETY: every call is forwarded unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        take(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::SeqCst);
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if size > layout.size() {
            take(size - layout.size());
        } else {
            HELD.fetch_sub(layout.size() - size, Ordering::SeqCst);
        }
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Returns the peak memory above the fixed allowance as a multiple of the file's size, and the result of reading.
fn taken(name: &str, file: Vec<u8>) -> (f64, Result<usize, FileError>) {
    let path = std::env::temp_dir().join(format!("pxpl5-memory-{}-{name}", std::process::id()));
    fs::write(&path, &file).expect("a temporary file");
    let size = file.len();
    drop(file);
    let before = HELD.load(Ordering::SeqCst);
    MOST.store(before, Ordering::SeqCst);
    let read = load(&path).map(|scene| scene.triangles().len());
    let most = MOST.load(Ordering::SeqCst) - before;
    fs::remove_file(path).expect("it is there");
    assert!(most as u64 <= MEMORY_TIMES_FILE * size as u64 + MEMORY_FLOOR_BYTES, "{name}: {most} bytes for {size}");
    let times = most as f64 / size as f64;
    (times, read)
}

fn is_accepted(name: &str, file: Vec<u8>) {
    let size = file.len();
    let (times, read) = taken(name, file);
    // Every reader takes up to 64 KiB.
    assert!(read.is_ok() && (times - 7.0) * size as f64 <= 65536.0, "{name}: {times}, {read:?}");
}

/// Returns `count` points on a spiral as text lines that begin with `key`.
fn points(key: &str, count: usize) -> String {
    (0..count).fold(String::new(), |mut text, n| {
        writeln!(text, "{key}{} {} {}", n % 10, n / 10 % 10, n / 100 % 10).expect("into a string");
        text
    })
}

fn obj_of_corners(points_and_normals: usize) -> Vec<u8> {
    let mut text = points("v ", points_and_normals) + &points("vn ", points_and_normals) + "f";
    for point in 1..=points_and_normals {
        (1..=points_and_normals).for_each(|normal| write!(text, " {point}//{normal}").expect("into a string"));
    }
    text.into_bytes()
}

#[test]
fn hostile_obj_files_need_at_most_seven_times_their_size() {
    let _alone = alone();
    // The four cases of docs/hardening.md, and the worst known case for each list of the reader.
    is_accepted("corners.obj", obj_of_corners(500));
    is_accepted("short-corners.obj", obj_of_corners(99));
    is_accepted("many-corners.obj", obj_of_corners(1100));
    // A file without area is refused, so a triangle with an area is added beside the polygon.
    let seen = points("v ", 9) + "v 0 5 0\nf 1 2 10\n";
    is_accepted("polygon.obj", (seen.clone() + "f" + &" 1 2".repeat(900_000)).into_bytes());
    is_accepted("apart.obj", "v 1 2 3\nv 4 5 6\nv 7 8 0\nf -1 -2 -3\n".repeat(400_000).into_bytes());
    is_accepted(
        "nines.obj",
        (seen.clone() + &(points("v ", 9) + "f -1 -2 -3 -4 -5 -6 -7 -8 -9\n").repeat(60_000)).into_bytes(),
    );
    let window = "v .1 0 1\nvn 0 0 1\nf -1//-1 -1//-2 -1//-3 -1//-4 -1//-5 -1//-6 -1//-7 -1//-8 -1//-9\n";
    is_accepted(
        "window.obj",
        (seen.clone() + &points("v ", 9) + &points("vn ", 9) + &window.repeat(60_000)).into_bytes(),
    );
    // A polygon with many notches, which is divided by cutting ears, and faces without smoothing.
    let comb: String = (0..15_000).fold(String::new(), |mut text, n| {
        writeln!(text, "v {} {} 0", if n % 2 == 0 { 9.5 } else { 1.25 }, f64::from(n) / 1e3).expect("into a string");
        text
    });
    let face: String = (1..=15_002).fold(String::from("f"), |mut text, n| {
        write!(text, " {n}").expect("into a string");
        text
    });
    let (_, faces) = taken("flat.obj", (points("v ", 999) + &"f 1 22 500\n".repeat(500_000)).into_bytes());
    assert!(matches!(faces, Err(ref error) if error.kind == FileErrorKind::TooLarge), "{faces:?}");
    let smooth = points("v ", 999) + "s 1\n" + &"f 1 22 500\n".repeat(500_000);
    is_accepted("smooth.obj", smooth.into_bytes());
    let (_, comb) = taken("comb.obj", format!("{comb}v 20 15 0\nv 20 -1 0\n{face}\n").into_bytes());
    assert!(comb.is_ok(), "{comb:?}");
    is_accepted("points.obj", (points("v ", 1_000_000) + "f 1 2 30\n").into_bytes());
    is_accepted("normals.obj", (seen + &points("vn ", 1_000_000) + "f 1//1 2//2 3\n").into_bytes());
}

#[test]
fn real_meshes_need_little_memory() {
    let _alone = alone();
    // A grid as a scanner makes it: shared vertices, two triangles a square.
    let side = 700;
    let mut text = String::new();
    for n in 0..side * side {
        writeln!(text, "v {}.{:03} {}.5 0.25", n % side, n % 997, n / side).expect("into a string");
    }
    for square in 0..(side - 1) * (side - 1) {
        let corner = square / (side - 1) * side + square % (side - 1) + 1;
        writeln!(text, "f {corner} {} {} {}", corner + 1, corner + side + 1, corner + side).expect("into a string");
    }
    is_accepted("grid.obj", text.into_bytes());
}

/// Returns a binary file of one polygon with byte coordinates.
fn ply(kind: &str, vertices: usize, vertex: &[u8], corners: impl Iterator<Item = Vec<u8>>, count: usize) -> Vec<u8> {
    let properties: String = ["x", "y", "z"].map(|axis| format!("property char {axis}\n")).concat();
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\n{properties}element face 1\n\
         property list uint {kind} vertex_indices\nend_header\n"
    );
    let mut file = header.into_bytes();
    // A file without area is refused, so the first three vertices form a triangle with an area.
    file.extend([1, 2, 3, 2, 2, 3, 1, 3, 3]);
    file.extend(vertex.repeat(vertices - 3));
    file.extend((count as u32).to_le_bytes());
    file.extend(corners.flatten());
    file
}

#[test]
fn hostile_ply_files_need_at_most_seven_times_their_size_or_are_refused() {
    let _alone = alone();
    let count = 2_000_000;
    let (_, bytes) = taken("bytes.ply", ply("uchar", 3, &[1, 2, 3], (0..count).map(|n| vec![(n % 3) as u8]), count));
    assert!(matches!(bytes, Err(ref error) if error.kind == FileErrorKind::Syntax), "{bytes:?}");
    let shorts = (0..count).map(|n| ((n % 60_000) as u16).to_le_bytes().to_vec());
    let (_, shorts) = taken("shorts.ply", ply("ushort", 60_000, &[1, 2, 3], shorts, count));
    assert!(matches!(shorts, Err(ref error) if error.kind == FileErrorKind::Syntax), "{shorts:?}");
    let words = (0..count).map(|n| (n as u32).to_le_bytes().to_vec());
    let (_, words) = taken("words.ply", ply("uint", count, &[1, 2, 3], words, count));
    assert!(matches!(words, Err(ref error) if error.kind == FileErrorKind::TooLarge), "{words:?}");
    is_accepted("unused.ply", ply("uint", count, &[1, 2, 3], (0..3u32).map(|n| n.to_le_bytes().to_vec()), 3));
}

#[test]
fn ascii_ply_and_pdb_files_need_at_most_seven_times_their_size() {
    let _alone = alone();
    let header = |vertices: usize, faces: usize| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty double x\nproperty double y\nproperty double z\n\
             element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
        )
    };
    let count = 600_000;
    let faces: String = (0..count / 3).map(|n| format!("3 {} {} {}\n", 3 * n, 3 * n + 1, 3 * n + 2)).collect();
    is_accepted("apart.ply", (header(count, count / 3) + &points("", count) + &faces).into_bytes());
    let (_, polygon) =
        taken("polygon.ply", (header(9, 1) + &points("", 9) + &format!("{count}") + &" 1".repeat(count)).into_bytes());
    assert!(matches!(polygon, Err(ref error) if error.kind == FileErrorKind::Syntax), "{polygon:?}");
    let atom = "ATOM      1  N   SER A   1      11.000  -2.000   0.500\n";
    is_accepted("atoms.pdb", atom.repeat(60_000).into_bytes());
    let others: String = (0..60_000)
        .map(|n| {
            format!(
                "ATOM  {:5}  N {}SER A{:4}      11.000  -2.000   0.500\n",
                n % 100_000,
                ["A", "B"][n % 2],
                n % 9_999
            )
        })
        .collect();
    is_accepted("locations.pdb", others.into_bytes());
}
