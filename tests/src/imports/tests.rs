//! Planted mistakes are found, and what is in order is not.

use super::{Files, Graph, circles, dependencies, order_that_fits, rooms};

fn graph(files: &[(&str, &str)]) -> Graph {
    let files: Files = files.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect();
    Graph::read(&files, "lib.rs").expect("all files are there")
}

/// The arrows between files, without those from the root.
fn arrows(graph: &Graph) -> Vec<String> {
    let all = graph.imports.keys().filter(|(from, _)| *from != 0);
    all.map(|&(from, to)| format!("{} → {}", graph.name(from), graph.name(to))).collect()
}

#[test]
fn a_circle_of_two_files_is_found() {
    let planted = graph(&[
        ("lib.rs", "mod a;\nmod b;"),
        ("a.rs", "use crate::b::B;\npub struct A;"),
        ("b.rs", "pub struct B;\nfn f(_: super::a::A) {}"),
    ]);
    let found = circles(&planted);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("circle of 2 files: a.rs, b.rs"), "{found:?}");
    assert!(found[0].contains("a.rs:1: crate::b::B → b.rs"), "{found:?}");
    assert!(found[0].contains("b.rs:2: super::a::A → a.rs"), "{found:?}");
    // Without one of the arrows there is none.
    let mended =
        graph(&[("lib.rs", "mod a;\nmod b;"), ("a.rs", "use crate::b::B;"), ("b.rs", "pub struct B;")]);
    assert!(circles(&mended).is_empty());
}

#[test]
fn a_circle_behind_re_exports_and_nested_trees_is_found() {
    let planted = graph(&[
        ("lib.rs", "mod a; mod b; mod c;\npub use a::A; pub use c::{C as Cc, inner::*};"),
        ("a.rs", "pub struct A; use crate::{b::{self, B}};"),
        ("b.rs", "pub struct B; use crate::{Cc};"),
        ("c.rs", "pub mod inner; pub struct C; fn f() -> crate::A { todo!() }"),
        ("c/inner.rs", "pub struct D;"),
    ]);
    assert_eq!(arrows(&planted), ["a.rs → b.rs", "b.rs → c.rs", "c.rs → a.rs", "c.rs → c/inner.rs"]);
    assert!(circles(&planted)[0].starts_with("circle of 3 files"));
}

#[test]
fn what_is_passed_on_by_a_star_counts_where_it_is_named() {
    let graph = graph(&[
        ("lib.rs", "mod room;"),
        ("room/mod.rs", "mod a; mod b; use a::{A, f};"),
        ("room/a.rs", "pub struct A; pub fn f() {}"),
        ("room/b.rs", "use super::*; fn g(_: A) {}"),
    ]);
    assert!(arrows(&graph).contains(&"room/b.rs → room/a.rs".to_owned()), "{:?}", arrows(&graph));
}

#[test]
fn a_module_and_its_submodules_may_know_each_other() {
    let parent = ("lib.rs", "mod a; pub const LIMIT: u8 = 1;");
    let family = graph(&[
        parent,
        ("a.rs", "mod x; mod y; use y::Y; pub struct A; use x::X;"),
        ("a/x.rs", "use super::A; pub struct X(u8); const L: u8 = crate::LIMIT;"),
        ("a/y.rs", "use super::{A, x::X}; pub struct Y;"),
    ]);
    assert_eq!(circles(&family), Vec::<String>::new());
    // The submodules among themselves may not.
    let planted = graph(&[
        parent,
        ("a.rs", "mod x; mod y; use y::Y; pub struct A; use x::X;"),
        ("a/x.rs", "use super::{A, Y}; pub struct X(u8);"),
        ("a/y.rs", "use super::{A, x::X}; pub struct Y;"),
    ]);
    assert!(circles(&planted)[0].starts_with("circle of 2 files: a/x.rs, a/y.rs"));
}

#[test]
fn a_parent_hides_no_circle_through_another_module() {
    let planted = graph(&[
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "mod x; pub struct A; use crate::b::B;"),
        ("a/x.rs", "use super::A;"),
        ("b.rs", "pub struct B; use crate::a::x::X;"),
    ]);
    assert!(circles(&planted)[0].starts_with("circle of 3 files: a.rs, a/x.rs, b.rs"));
}

#[test]
fn tests_strings_comments_and_visibility_import_nothing() {
    let graph = graph(&[
        ("lib.rs", "mod a;\nmod b;\n#[cfg(test)]\nmod only_for_tests;\n#[cfg(all(test, unix))] mod too;"),
        (
            "a.rs",
            "//! crate::b::B\nconst A: &str = \"crate::b::B\"; pub(in crate::b) fn f() {}\n\
             #[cfg(test)]\nmod tests { use crate::b::B; fn g() { crate::b::f() } }\n\
             #[cfg(test)] use crate::{b::B, c}; #[cfg(test)] fn t() -> [u8; 2] { crate::b::f() }\n\
             struct S { #[cfg(test)] x: crate::b::B, y: u8 }\nuse ::b::B as Other; fn b() { x.b::<u8>(); }",
        ),
        ("b.rs", "pub struct B;"),
    ]);
    assert_eq!(arrows(&graph), Vec::<String>::new());
}

#[test]
fn an_arrow_against_the_order_of_rooms_is_found() {
    let files = |root| {
        graph(&[
            ("lib.rs", root),
            ("gpu/mod.rs", "pub mod layout;"),
            ("gpu/layout.rs", "\npub fn entry() -> u8 { crate::model::SIZE }"),
            ("model.rs", "pub const SIZE: u8 = 1;"),
        ])
    };
    let planted = files("mod gpu;\nmod model;");
    assert!(circles(&planted).is_empty());
    assert_eq!(rooms(&planted), ["gpu/layout.rs:2: crate::model::SIZE: model stands behind gpu in lib.rs"]);
    assert_eq!(order_that_fits(&planted), ["model", "gpu"]);
    assert!(rooms(&files("mod model;\nmod gpu;")).is_empty());
}

#[test]
fn rooms_within_a_room_that_import_each_other_are_found() {
    let planted = graph(&[
        ("lib.rs", "mod w;"),
        ("w/mod.rs", "mod a; mod b;"),
        ("w/a/mod.rs", "mod one; mod two;"),
        ("w/a/one.rs", "pub struct One;"),
        ("w/a/two.rs", "use crate::w::b::B;"),
        ("w/b.rs", "pub struct B; use super::a::one::One;"),
    ]);
    assert!(circles(&planted).is_empty());
    assert_eq!(rooms(&planted).len(), 1, "{:?}", rooms(&planted));
}

#[test]
fn a_missing_file_is_an_error_with_its_place() {
    let files = Files::from([("lib.rs".to_owned(), "mod a;".to_owned())]);
    assert_eq!(Graph::read(&files, "lib.rs").err().as_deref(), Some("lib.rs:1: no file for mod a"));
}

#[test]
fn dependencies_are_those_of_the_table() {
    let table =
        "| `crates/a` | what | – |\n| `crates/b` | what | a |\n| `crates/c` | what | any of the above |\n";
    let b = "[package]\nname = \"b\"\n[dependencies]\na.workspace = true\nglam.workspace = true\n";
    let c = "[dependencies]\nb = { workspace = true }\n[dev-dependencies]\na.workspace = true\n";
    assert_eq!(dependencies(table, &[("a", ""), ("b", b), ("c", c)]), Vec::<String>::new());
    let a = "[dependencies]\nc.workspace = true\n";
    assert_eq!(
        dependencies(table, &[("a", a), ("b", b), ("c", c)]),
        ["a depends on c, but not in ARCHITECTURE.md"]
    );
    let found = dependencies(table, &[("a", ""), ("b", ""), ("c", c)]);
    assert_eq!(found, ["ARCHITECTURE.md says that b depends on a, but it does not"]);
    let found = dependencies("| `crates/a` | what | z |\n", &[("a", ""), ("b", "")]);
    assert_eq!(found.len(), 3, "{found:?}");
}
