use super::*;
use crate::time::{PS_PER_MS, PS_PER_S};
use pxpl5_sim::parameters::{FileError, FileErrorKind};

const HEADER: &str = "time_s,x,y,z,qw,qx,qy,qz\n";

fn load(rows: &str) -> Result<Recording, FileError> {
    Recording::read(format!("{HEADER}{rows}").as_bytes())
}

#[test]
fn poses_between_two_samples_are_interpolated() {
    let recording = load("1,0,0,0,1,0,0,0\n2, 2,0,0, 0.70710678,0,0.70710678,0\n").unwrap();
    let pose = recording.pose(PS_PER_S * 3 / 2);
    assert!((pose.position - DVec3::X).length() < 1e-12);
    assert!(pose.angle_deg(&Pose::facing(rotation::about_y(45f64.to_radians()))) < 1e-6);
    assert!((recording.angular_velocity(PS_PER_S * 3 / 2).y - 90f64.to_radians()).abs() < 1e-6);
    assert_eq!(recording.velocity(PS_PER_S), DVec3::X * 2.0);
}

#[test]
fn with_the_end_held_the_head_stands_still_before_and_after_the_recording() {
    let recording = load("1,5,0,0,1,0,0,0\n2,6,0,0,1,0,0,0\n").unwrap();
    assert_eq!(recording.ends_ps(), Some(2 * PS_PER_S), "a run must not go on after it");
    let held = recording.ending(End::Hold);
    assert_eq!(held.pose(0).position.x, 5.0);
    assert_eq!(held.pose(3 * PS_PER_S).position.x, 6.0);
    assert_eq!(held.velocity(3 * PS_PER_S), DVec3::ZERO);
    assert_eq!(held.ends_ps(), None);
}

#[test]
fn a_looped_recording_starts_again() {
    let recording = load("1,5,0,0,1,0,0,0\n2,6,0,0,1,0,0,0\n").unwrap().ending(End::Loop);
    for (ms, x) in [(1_250, 5.25), (2_000, 6.0), (2_250, 5.25), (7_750, 5.75)] {
        assert!((recording.pose(ms * PS_PER_MS).position.x - x).abs() < 1e-12, "{ms} ms");
    }
    assert_eq!(recording.velocity(7_750 * PS_PER_MS), DVec3::X);
    let alone = load("1,5,0,0,1,0,0,0\n").unwrap().ending(End::Loop);
    assert_eq!(alone.pose(9 * PS_PER_S).position.x, 5.0);
}

#[test]
fn bad_rows_are_named_by_line_and_column_with_times_in_seconds() {
    let good = "0.5,0,0,0,1,0,0,0\n";
    let cases = [
        ("1,0,0,NaN,1,0,0,0\n", "line 3, z: expected a finite number, found \"NaN\""),
        ("1,0,0,0,inf,0,0,0\n", "line 3, qw: expected a finite number, found \"inf\""),
        ("1,0,0,zero,1,0,0,0\n", "line 3, z: expected a finite number, found \"zero\""),
        ("soon,0,0,0,1,0,0,0\n", "line 3, time_s: expected a finite number, found \"soon\""),
        ("1,0,0,0,1,0,0\n", "line 3: expected 8 fields, found 7"),
        ("1,0,0,0,1,0,0,0,9\n", "line 3: expected 8 fields, found 9"),
        ("0.25,0,0,0,1,0,0,0\n", "line 3, time_s: expected 0.5 s or more, the time of the line before, found 0.25 s"),
        ("1e9,0,0,0,1,0,0,0\n", "line 3, time_s: expected 0 to 10000000 s, found 1000000000 s"),
        ("1,0,0,0,0,0,0,0\n", "line 3, qw,qx,qy,qz: expected a quaternion of length 1, found 0"),
    ];
    for (row, message) in cases {
        assert_eq!(load(&format!("{good}{row}")).unwrap_err().to_string(), message);
    }
    let negative = load("-1,0,0,0,1,0,0,0\n").unwrap_err();
    assert_eq!(negative.to_string(), "line 2, time_s: expected 0 to 10000000 s, found -1 s");
}

#[test]
fn impossible_positions_and_speeds_of_a_head_are_refused() {
    let good = "0.5,0,0,0,1,0,0,0\n";
    for (row, message) in [
        ("1,0,1e308,0,1,0,0,0\n", "line 3, y: expected -1e8 to 1e8 m, found 1e308 m"),
        (
            "0.500000000001,1e7,0,0,1,0,0,0\n",
            "line 3: expected at most 1e6 m/s and 1e6 rad/s from the line before, found 1e19 m/s",
        ),
    ] {
        assert_eq!(load(&format!("{good}{row}")).unwrap_err().to_string(), message);
    }
    // Half a turn, pi rad, within 1 us.
    let turned = load(&format!("{good}0.500001,0,0,0,0,0,1,0\n")).unwrap_err().to_string();
    assert!(turned.contains("found 3.14159265") && turned.ends_with("e6 rad/s"), "{turned}");
    // A jump of 10 m and of half a turn within 10 us.
    assert!(load(&format!("{good}0.50001,10,0,0,0,0,1,0\n")).is_ok());
    // 10^8 m in 900 s.
    let far = load(&format!("{good}900,99999999,0,0,1,0,0,0\n")).expect("a map's coordinates");
    assert!(far.velocity(PS_PER_S).is_finite());
}

#[test]
fn an_empty_recording_and_bytes_that_are_not_text_are_errors() {
    let kind = |bytes: &[u8]| Recording::read(bytes).expect_err("no recording").kind;
    for empty in ["", "# nothing but a comment\n", HEADER] {
        assert_eq!(kind(empty.as_bytes()), FileErrorKind::Empty, "{empty:?}");
    }
    assert_eq!(kind(b"\xff\xfe"), FileErrorKind::Unreadable);
    // Comments may be in any encoding.
    let commented = Recording::read(&b"# Universit\xe9\n0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"[..]).unwrap();
    assert_eq!(commented.n_samples(), 2);
}

#[test]
fn unknown_columns_are_an_error_that_lists_the_known_columns() {
    let error = Recording::read(&b"t,x,y,z\n0,0,0,0\n"[..]).unwrap_err();
    let message = error.to_string();
    assert!(message.starts_with("line 1: expected the columns time_s,x,y,z,qw,qx,qy,qz, a EuRoC file"), "{message}");
    assert!(message.ends_with("found t,x,y,z"), "{message}");
}

// One motion in three kinds of file. The head stands at (0, 1.7, 0) and looks along -z. Half a second later it has made
// a quarter turn to the left and moved to (0.25, 1.7, -0.5). Then it looks 30 degrees up. In the other two files up is
// z, and y replaces -z. The quaternions were computed by hand from matrices whose columns are the directions of the
// sensor's axes. At the start the optical frame has x east, y down, z north: (w, x, y, z) = (s, -s, 0, 0) with s =
// sqrt(1/2). EuRoC's frame has x up, y east, z north: (1, -1, -1, -1) / 2.
const OWN: &str = "time_s,x,y,z,qw,qx,qy,qz
0,0,1.7,0,1,0,0,0
0.5,0.25,1.7,-0.5,0.70710678,0,0.70710678,0
1,0.25,1.7,-0.5,0.96592583,0.25881905,0,0
";
const TUM: &str = "# ground truth trajectory
# timestamp tx ty tz qx qy qz qw
1305031098.6659 0 0 1.7 -0.70710678 0 0 0.70710678
1305031099.1659 0.25 0.5 1.7 -0.5 -0.5 0.5 0.5

1305031099.6659   0.25 0.5 1.7 -0.5 0 0 0.8660254
";
const EUROC: &str = "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], v_RS_R_x [m s^-1]
1403636580838555648,0,0,1.7,0.5,-0.5,-0.5,-0.5,0.1
1403636581338555648,0.25,0.5,1.7,0.70710678,0,-0.70710678,0,0.2
1403636581838555648,0.25,0.5,1.7,0.61237244,-0.35355339,-0.35355339,-0.61237244,0.3
";

#[test]
fn the_same_motion_in_three_formats_gives_the_same_poses() {
    let own = Recording::read(OWN.as_bytes()).unwrap();
    let left = Pose { position: DVec3::new(0.25, 1.7, -0.5), orientation: rotation::about_y(90f64.to_radians()) };
    assert!(own.pose(PS_PER_S / 2).angle_deg(&left) < 1e-6 && own.pose(PS_PER_S / 2).distance_m(&left) < 1e-12);
    for (name, text) in [("TUM", TUM), ("EuRoC", EUROC)] {
        let other = Recording::read(text.as_bytes()).unwrap();
        assert_eq!(other.span_ps(), (0, PS_PER_S), "{name}");
        for ms in [0, 250, 500, 700, 1_000] {
            let expected = own.pose(ms * PS_PER_MS);
            let found = other.pose(ms * PS_PER_MS);
            assert!(found.angle_deg(&expected) < 2e-6, "{name} at {ms} ms: {}", found.angle_deg(&expected));
            assert!(found.distance_m(&expected) < 1e-12, "{name} at {ms} ms");
        }
    }
}

#[test]
fn errors_of_other_formats_name_their_own_columns() {
    let tum = TUM.replace("0.25 0.5 1.7 -0.5 -0.5", "0.25 0.5 up -0.5 -0.5");
    let message = Recording::read(tum.as_bytes()).unwrap_err().to_string();
    assert_eq!(message, "line 4, tz: expected a finite number, found \"up\"");
    let euroc = EUROC.replace("1403636581338555648", "1403636580338555648");
    let message = Recording::read(euroc.as_bytes()).unwrap_err().to_string();
    assert_eq!(message, "line 3, timestamp [ns]: expected 0 s or more, the time of the line before, found -0.5 s");
    let short = EUROC.replace(",-0.70710678,0,0.2", "");
    assert_eq!(Recording::read(short.as_bytes()).unwrap_err().to_string(), "line 3: expected 8 fields, found 6");
}

/// Reads a recording whose columns a mapping names.
fn mapped(text: &str, mapping: &str) -> Result<Recording, String> {
    let columns = Columns::parse(mapping).map_err(|error| error.to_string())?;
    let format = RecordingFormat { columns, ..RecordingFormat::default() };
    Recording::read_as(text.as_bytes(), &format).map_err(|error| error.to_string())
}

#[test]
fn other_columns_are_read_by_a_mapping_of_names_or_numbers() {
    let named =
        "frame;qx;qy;qz;qw;px;py;pz;stamp\n7;0;0;0;1;0;1700;0;20.5\n8;0;0.70710678;0;0.70710678;250;1700;-500;520.5\n";
    let by_name = mapped(named, "t_ms=stamp,x_mm=px,y_mm=py,z_mm=pz,qw=qw,qx=qx,qy=qy,qz=qz").unwrap();
    let numbered: String = named.lines().skip(1).map(|line| line.replace(';', " ") + "\n").collect();
    let by_number = mapped(&numbered, "t_ms=9,x_mm=6,y_mm=7,z_mm=8,qw=5,qx=2,qy=3,qz=4").unwrap();
    assert_eq!(by_name, by_number);
    let own = Recording::read(OWN.as_bytes()).unwrap();
    for ms in [0, 300, 500] {
        assert!(by_name.pose(ms * PS_PER_MS).angle_deg(&own.pose(ms * PS_PER_MS)) < 1e-6);
        assert!(by_name.pose(ms * PS_PER_MS).distance_m(&own.pose(ms * PS_PER_MS)) < 1e-12);
    }
}

#[test]
fn an_incomplete_mapping_is_an_error() {
    for (mapping, found) in [
        ("t=1,x=2,y=3", "found t=1,x=2,y=3"),
        ("t=1,t_ms=2", "found t and t_ms"),
        ("u=1", "found `u`"),
        ("t", "found `t`"),
    ] {
        let message = mapped("1,2,3\n", mapping).unwrap_err();
        assert!(
            message.starts_with("columns: expected t (or t_ms") && message.ends_with(found),
            "{mapping}: {message}"
        );
    }
    let error = mapped("time,x,y,z,w,i,j,k\n", "t=stamp,x=x,y=y,z=z,qw=w,qx=i,qy=j,qz=k").unwrap_err();
    assert_eq!(error, "line 1: expected a column `stamp` for t, found time, x, y, z, w, i, j, k");
}

#[test]
fn axes_can_be_chosen() {
    // A robot that faces north and makes a quarter turn to the left about its upward z axis.
    let text = "1 0 0 1.7 0 0 0.70710678 0.70710678\n2 0 0 1.7 0 0 1 0\n";
    let format = RecordingFormat { axes: Some(Axes::Robot), ..RecordingFormat::default() };
    let recording = Recording::read_as(text.as_bytes(), &format).unwrap();
    assert!(recording.pose(0).angle_deg(&Pose::IDENTITY) < 1e-6, "north is -z");
    let left = Pose::facing(rotation::about_y(90f64.to_radians()));
    assert!(recording.pose(PS_PER_S).angle_deg(&left) < 1e-6);
}

#[test]
fn the_first_of_simultaneous_samples_is_kept_and_the_others_are_reported() {
    let twice = "0.0 0 0 0 0 0 0 1\n1.0 0 0 0 0 0 0 1\n1.0 0.001 0 0 0 0 0 1\n4.0 0 0 0 0 0 0 1\n";
    let recording = Recording::read(twice.as_bytes()).unwrap();
    assert_eq!((recording.n_samples(), recording.pose(PS_PER_S).position), (3, DVec3::ZERO));
    assert_eq!(recording.warnings(), ["line 3 repeats the time of the line before: its pose is left out"]);
    let thrice =
        "\u{feff}# caf\u{e9}\r\n\r\n5\t0 0 0 0 0 0 1\r\n5.0 1 0 0 0 0 0 1\r\n5e0 2 0 0 0 0 0 1\r\n6 3 0 0 0 0 0 1\r\n";
    let recording = Recording::read(thrice.as_bytes()).unwrap();
    assert_eq!(recording.n_samples(), 2);
    let expected = ["2 lines repeat the time of the line before, first line 4: their poses are left out"];
    assert_eq!(recording.warnings(), expected);
    let own = load("1,5,0,0,1,0,0,0\n1,6,0,0,1,0,0,0\n2,7,0,0,1,0,0,0\n").unwrap();
    assert_eq!((own.n_samples(), own.warnings().len()), (2, 1));
    let euroc = EUROC.replace("1403636581338555648", "1403636580838555648");
    assert_eq!(Recording::read(euroc.as_bytes()).unwrap().n_samples(), 2);
    let back = "0 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n";
    let message = Recording::read(back.as_bytes()).unwrap_err().to_string();
    assert_eq!(message, "line 3, timestamp: expected 2 s or more, the time of the line before, found 1 s");
}

/// Returns a recording of three seconds with 100 samples per second, without the samples from `from_ms` to `to_ms`.
fn with_gap(from_ms: u64, to_ms: u64) -> String {
    let times = (0..300).map(|n| 10 * n).filter(|ms| !(from_ms + 1..to_ms).contains(ms));
    times.map(|ms| format!("{}.{:03},{}e-3,0,0,1,0,0,0\n", ms / 1000, ms % 1000, ms)).collect()
}

#[test]
fn a_gap_causes_a_warning_and_a_run_needs_a_held_head_to_cross_the_gap() {
    let recording = load(&with_gap(280, 2_490)).unwrap();
    assert_eq!(recording.warnings(), ["no pose for 2.210 s from 0.280 s on"]);
    let gap = (280 * PS_PER_MS, 2_490 * PS_PER_MS);
    for end in [End::Refuse, End::Loop] {
        let recording = recording.clone().ending(end);
        assert_eq!(recording.gap_ps(280 * PS_PER_MS), None, "a run that ends before it");
        assert_eq!(recording.gap_ps(281 * PS_PER_MS), Some(gap));
    }
    let held = recording.ending(End::Hold);
    assert_eq!(held.gap_ps(PS_PER_S), None);
    assert_eq!(held.pose(PS_PER_S).position.x, 0.280);
    assert_eq!((held.velocity(PS_PER_S), held.angular_velocity(PS_PER_S)), (DVec3::ZERO, DVec3::ZERO));
    assert!((held.pose(2_495 * PS_PER_MS).position.x - 2.495).abs() < 1e-12);
}

#[test]
fn short_pauses_and_slow_recordings_are_not_gaps() {
    assert!(load(&with_gap(280, 470)).unwrap().warnings().is_empty(), "less than a fifth of a second");
    assert_eq!(load(&with_gap(280, 530)).unwrap().warnings().len(), 1);
    let slow: String = [0, 1, 2, 6, 7, 8].map(|s| format!("{s},0,0,0,1,0,0,0\n")).concat();
    assert!(load(&slow).unwrap().warnings().is_empty(), "less than five times the usual time");
}

#[test]
fn samples_made_by_a_program_are_checked_like_samples_of_a_file() {
    let at = |s: f64| (s, Pose { position: DVec3::new(s.sin(), 1.7, -0.1), ..Pose::IDENTITY });
    let given = Recording::from_samples([at(0.0), at(0.125), at(1.0 / 3.0)]).expect("samples");
    assert_eq!((given.n_samples(), given.span_ps()), (3, (0, 333_333_333_333)));
    // The stored numbers keep all of their bits.
    assert_eq!(given.pose(125_000_000_000), at(0.125).1);
    let turned = Pose { orientation: glam::DQuat::from_xyzw(0.0, 0.0, 0.0, 2.0), ..Pose::IDENTITY };
    for (samples, says) in [
        (vec![], "expected at least one sample"),
        (vec![at(1.0), at(0.5)], "line 2, time_s: expected 1 s or more"),
        (vec![at(0.0), at(f64::NAN)], "line 2, time_s: expected a finite number"),
        (vec![at(-1.0)], "line 1, time_s: expected 0 to"),
        (vec![(0.0, turned)], "expected a quaternion of length 1, found 2"),
    ] {
        let error = Recording::from_samples(samples).expect_err(says).to_string();
        assert!(error.contains(says), "{error}");
    }
}

#[test]
fn named_columns_may_have_any_order_case_and_separator_beside_other_columns() {
    // The number of eight digits in OWN.
    let half: f64 = "0.70710678".parse().unwrap();
    let own = Recording::read(OWN.as_bytes()).unwrap();
    let rows = [(0.0, [0.0, 1.7, 0.0], [1.0, 0.0, 0.0, 0.0]), (0.5, [0.25, 1.7, -0.5], [half, 0.0, half, 0.0])];
    // Header, separator, and a line from time, position and quaternion (w, x, y, z).
    type Row = fn(f64, [f64; 3], [f64; 4]) -> Vec<String>;
    let cases: [(&str, &str, Row); 5] = [
        ("time_s,x,y,z,qx,qy,qz,qw", ",", |t, [x, y, z], [w, i, j, k]| {
            [t, x, y, z, i, j, k, w].map(|n| n.to_string()).to_vec()
        }),
        ("QW;QX;QY;QZ;frame;X;Y;Z;Time_S", ";", |t, [x, y, z], [w, i, j, k]| {
            [w, i, j, k, 7.0, x, y, z, t].map(|n| n.to_string()).to_vec()
        }),
        ("Timestamp [ms]\tPosX\tPosY\tPosZ\tRotX\tRotY\tRotZ\tRotW", "\t", |t, [x, y, z], [w, i, j, k]| {
            [1e3 * t, x, y, z, i, j, k, w].map(|n| n.to_string()).to_vec()
        }),
        ("t pz px py q_w q_x q_y q_z", " ", |t, [x, y, z], [w, i, j, k]| {
            [t, z, x, y, w, i, j, k].map(|n| n.to_string()).to_vec()
        }),
        (
            "head.position.x (mm),head.position.y (mm),head.position.z (mm),time_ns,quat_w,quat_x,quat_y,quat_z",
            ",",
            |t, p, q| {
                let [x, y, z] = p.map(|metres| 1e3 * metres);
                [x, y, z, 1e9 * t, q[0], q[1], q[2], q[3]].map(|n| n.to_string()).to_vec()
            },
        ),
    ];
    for (header, separator, row) in cases {
        let lines = rows.map(|(t, p, q)| row(t, p, q).join(separator) + "\n").concat();
        let recording =
            Recording::read(format!("{header}\n{lines}").as_bytes()).unwrap_or_else(|e| panic!("{header}: {e}"));
        assert_eq!(recording.span_ps(), (0, PS_PER_S / 2), "{header}");
        for ms in [0, 250, 500] {
            assert!(recording.pose(ms * PS_PER_MS).angle_deg(&own.pose(ms * PS_PER_MS)) < 1e-6, "{header}");
            assert!(recording.pose(ms * PS_PER_MS).distance_m(&own.pose(ms * PS_PER_MS)) < 1e-12, "{header}");
        }
    }
    // The names of TUM without `#` keep the axes of TUM.
    let named = TUM.replace("# ground truth trajectory\n# ", "");
    assert_eq!(Recording::read(named.as_bytes()).unwrap(), Recording::read(TUM.as_bytes()).unwrap());
}

#[test]
fn a_minus_before_a_column_changes_the_sign() {
    // The axes of Unity are left-handed: z and the turns about x and y have the opposite sign.
    let text = "a,b,c,d,e,f,g,h\n0,0.1,1.7,0.3,0.5,0.5,-0.5,0.5\n1,0.2,1.7,0.4,0.5,0.5,-0.5,0.5\n";
    let read = |columns: &str, axes| {
        let columns = Columns::parse(columns).unwrap();
        Recording::read_as(text.as_bytes(), &RecordingFormat { columns, axes, jumps: Jumps::Keep }).unwrap()
    };
    let by_sign = read("t=a,x=b,y=c,z=-d,qw=e,qx=-f,qy=-g,qz=h", None);
    assert_eq!(by_sign, read("t=a,x=b,y=c,z=d,qw=e,qx=f,qy=g,qz=h", Some(Axes::Unity)));
    assert_eq!(by_sign, read("t=1,x=2,y=3,z=-4,qw=5,qx=-6,qy=-7,qz=8", None));
    assert_eq!(by_sign.pose(0).position, DVec3::new(0.1, 1.7, -0.3));
}

#[test]
fn a_recording_that_begins_late_has_a_gap_before_its_first_pose() {
    let late = load("20,0,0,0,1,0,0,0\n20.1,0,0,0,1,0,0,0\n").unwrap();
    assert_eq!(late.warnings(), ["no pose for 20.000 s from 0.000 s on"]);
    assert_eq!(late.gap_ps(PS_PER_S), Some((0, 20 * PS_PER_S)));
    assert_eq!(late.ending(End::Hold).gap_ps(PS_PER_S), None);
    assert!(load("0.2,0,0,0,1,0,0,0\n0.3,0,0,0,1,0,0,0\n").unwrap().warnings().is_empty());
}

/// Returns lines at 100 Hz of a head at 1.6 m that moves by 5 mm with each line. Lines in `lost` have the text `pose`.
fn with_lost(lost: std::ops::Range<u64>, pose: &str) -> String {
    let good = |n: u64| format!("{},1.6,0,1,0,0,0", 0.005 * n as f64);
    let line =
        |n| format!("{}.{:02},{}\n", n / 100, n % 100, if lost.contains(&n) { pose.to_owned() } else { good(n) });
    (0..100).map(line).collect()
}

#[test]
fn lines_faster_than_a_head_are_reported_and_can_be_left_out() {
    let leave_out = RecordingFormat { jumps: Jumps::LeaveOut, ..RecordingFormat::default() };
    let read = |rows: &str| Recording::read_as(format!("{HEADER}{rows}").as_bytes(), &leave_out);
    let good = load(&with_lost(0..0, "")).unwrap();
    assert!(good.warnings().is_empty(), "{:?}", good.warnings());
    // 1.6 m within 10 ms are 160 m/s, on the way to the zeros and on the way back. The first line after 30 zeros could
    // be reached at 5 m/s.
    let zeros = load(&with_lost(31..34, "0,0,0,1,0,0,0")).unwrap();
    let [warning] = &zeros.warnings()[..] else { panic!("one warning") };
    assert!(
        warning.starts_with("2 lines in which the head moves too fast, first line 33 (161 m/s): a head"),
        "{warning}"
    );
    for (lost, pose) in [
        (31..34, "0,0,0,1,0,0,0"),
        (31..61, "0,0,0,1,0,0,0"),
        (0..3, "0,0,0,1,0,0,0"),
        (31..34, "0,0,0,0,0,0,0"),
        (31..34, "0,0,0,nan,nan,nan,nan"),
    ] {
        let kept = read(&with_lost(lost.clone(), pose)).unwrap();
        assert_eq!(kept.n_samples() as u64, 100 - (lost.end - lost.start), "{lost:?} {pose}");
        assert!(kept.warnings()[0].contains("left out"), "{:?}", kept.warnings());
        assert!((31..34).all(|n| kept.pose(n * 10 * PS_PER_MS).distance_m(&good.pose(n * 10 * PS_PER_MS)) < 1e-12));
    }
    // A turn of 30 degrees within 10 ms.
    let turned = load(&with_lost(31..100, "0.155,1.6,0,0.96592583,0,0.25881905,0")).unwrap().warnings();
    assert!(turned[0].starts_with("line 33: the head moves too fast (3000 deg/s)"), "{turned:?}");
    // The way of a head in centimetres, and times in milliseconds that are read as seconds.
    let centimetres: String = (0..50).map(|n| format!("{}e-2,{},160,0,1,0,0,0\n", n, 0.5 * f64::from(n))).collect();
    assert!(
        load(&centimetres).unwrap().warnings()[0].contains("50 m/s")
            && load(&centimetres).unwrap().warnings()[0].ends_with("in seconds?")
    );
    let milliseconds: String = (0..50).map(|n| format!("{},0,0,0,1,0,0,0\n", 11 * n)).collect();
    assert_eq!(
        load(&milliseconds).unwrap().warnings(),
        ["poses are 11 s apart, longer than a gap: is the unit of time right?"]
    );
}
