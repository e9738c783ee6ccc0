//! The book's examples of this command, and its page of the reference: see `tests/it/guides.rs` of the repository.

#[cfg(unix)]
#[path = "../../../tests/it/guides/examples.rs"]
mod examples;
#[path = "../../../tests/it/guides/help.rs"]
mod help;
#[path = "../../../tests/it/guides/page.rs"]
mod page;

#[test]
fn the_page_of_papers_is_its_help() {
    help::check("papers.md", "The comparisons of the papers");
}
