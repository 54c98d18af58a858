//! What the README repeats from generated documents is what they say.

fn read(name: &str) -> String {
    let path = format!("{}/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

#[test]
fn the_readme_shows_every_figure_of_accuracy_md_as_it_stands_there() {
    let (readme, accuracy) = (read("README.md"), read("ACCURACY.md"));
    let table = accuracy.lines().skip_while(|line| !line.starts_with("| # | figure"));
    let rows: Vec<_> = table.take_while(|line| line.starts_with('|')).collect();
    assert!(rows.len() > 15, "ACCURACY.md has lost its table");
    for row in rows {
        assert!(readme.contains(row), "the README lacks or has changed:\n{row}");
    }
}
