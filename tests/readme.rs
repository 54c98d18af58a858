//! Tests that the README agrees with the generated documents that it quotes.

fn read(name: &str) -> String {
    let path = format!("{}/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Returns the paragraph of ACCURACY.md with both means, on one line.
pub(crate) fn headline() -> String {
    let accuracy = read("ACCURACY.md");
    let paragraph = accuracy.split("\n\n").find(|paragraph| paragraph.starts_with("Of ")).expect("the headline");
    paragraph.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn the_readme_has_both_means_of_accuracy_md() {
    let readme = read("README.md").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(readme.contains(&headline()), "README.md must say: {}", headline());
}

/// Returns the files that a page links to, without anchors and without external links.
fn links(page: &str) -> Vec<&str> {
    let all = page.split("](").skip(1).filter_map(|rest| rest.split([')', ' ']).next());
    let local = all.filter(|link| !link.contains("://") && !link.starts_with('#'));
    local.map(|link| link.split('#').next().unwrap_or(link)).collect()
}

/// Returns the pages of a folder and its subfolders, relative to the repository.
fn pages(folder: &str) -> Vec<String> {
    let path = format!("{}/{folder}", env!("CARGO_MANIFEST_DIR"));
    let entries = std::fs::read_dir(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let names = entries.map(|entry| format!("{folder}/{}", entry.expect("readable").file_name().to_string_lossy()));
    names
        .flat_map(|name| if name.contains('.') { vec![name] } else { pages(&name) })
        .filter(|name| name.ends_with(".md"))
        .collect()
}

#[test]
fn every_link_of_the_documents_leads_to_a_file() {
    let own = ["README.md", "ARCHITECTURE.md", "ACCURACY.md", "CHANGELOG.md", "CONTRIBUTING.md", "paper/paper.md"];
    let own = own.map(str::to_owned);
    for page in pages("docs").into_iter().chain(own) {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(&page);
        for link in links(&read(&page)) {
            let file = folder.parent().expect("a file is in a folder").join(link);
            assert!(file.exists(), "{page} links to {link}, which is not there");
        }
    }
}

#[test]
fn the_summary_of_the_guide_lists_every_page() {
    let summary = read("docs/SUMMARY.md");
    let listed = links(&summary);
    for page in pages("docs").iter().filter_map(|page| page.strip_prefix("docs/")).filter(|page| *page != "SUMMARY.md")
    {
        assert!(listed.contains(&page), "docs/SUMMARY.md lacks {page}");
    }
}

/// Files to be made are in the last column of the table, after the files at which a task begins.
#[test]
fn every_first_task_names_an_existing_file() {
    let page = read("docs/first-tasks.md");
    let rows: Vec<&str> = page.lines().filter(|line| line.starts_with("| ")).skip(1).collect();
    assert_eq!(rows.len(), 10, "ten tasks");
    for row in rows {
        let begin = row.split(" | ").nth(2).unwrap_or_else(|| panic!("no third column: {row}"));
        let files = begin.split('`').skip(1).step_by(2).filter(|name| name.contains('/'));
        for file in files {
            assert!(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(file).exists(), "{file} is not there");
        }
    }
}

#[cfg(unix)]
#[test]
fn the_table_of_scripts_has_each_script_once() {
    use std::os::unix::fs::PermissionsExt;
    let folder = format!("{}/scripts", env!("CARGO_MANIFEST_DIR"));
    let entries = std::fs::read_dir(folder).expect("the scripts").map(|entry| entry.expect("readable"));
    let programs = entries.filter(|entry| {
        let data = entry.metadata().expect("readable");
        data.is_file() && data.permissions().mode() & 0o111 != 0
    });
    let mut found: Vec<String> = programs.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    found.sort();
    let text = read("scripts/README.md");
    let rows = text.lines().filter_map(|line| line.strip_prefix("| `")?.split_once("` |"));
    assert_eq!(rows.map(|(name, _)| name).collect::<Vec<_>>(), found);
}

#[test]
fn the_readme_has_the_table_of_the_last_measurement_of_levels() {
    let record = pxpl5::levels::LevelRecord::read(&read("crates/pxpl5-cli/src/levels.json")).expect("a record");
    let table = record.table();
    let is_fresh = read("README.md").contains(&format!("<!-- levels -->\n\n{table}\n<!-- end of levels -->"));
    assert!(is_fresh, "README.md must have between the marks of levels:\n{table}");
}
