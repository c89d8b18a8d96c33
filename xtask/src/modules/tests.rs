use super::{Crate, arrows, circles, on_circles};
use crate::source::Source;

/// A crate of these files below `x/src`.
fn tree(files: &[(&str, &str)]) -> Crate {
    let source = |(path, text): &(&str, &str)| Source {
        path: format!("x/src/{path}").into(),
        text: (*text).to_owned(),
    };
    let sources: Vec<Source> = files.iter().map(source).collect();
    Crate::of(sources[0].path.as_path(), &sources).unwrap()
}

/// Its arrows as `from > to : line`.
fn drawn(files: &[(&str, &str)]) -> Vec<String> {
    let tree = tree(files);
    let arrows = arrows(&tree);
    let name = |module| tree.name(module);
    let line = |a: &super::Arrow| format!("{} > {} : {}", name(a.from), name(a.to), a.line);
    arrows.iter().map(line).collect()
}

fn number_of_circles(files: &[(&str, &str)]) -> usize {
    circles(&arrows(&tree(files))).len()
}

#[test]
fn a_re_export_leads_to_the_module_that_defines_the_name() {
    let files = [
        (
            "lib.rs",
            "mod apple;\nmod branch;\npub use {apple::Apple, branch::*};\n",
        ),
        (
            "apple.rs",
            "use crate::{\n    Branch,\n};\npub struct Apple;\n",
        ),
        (
            "branch.rs",
            "pub mod twig;\npub use twig::Twig as Branch;\n",
        ),
        ("branch/twig.rs", "pub struct Twig;\n"),
    ];
    assert_eq!(
        drawn(&files),
        ["apple > branch::twig : 2", "branch > branch::twig : 2"]
    );
    assert_eq!(number_of_circles(&files), 0);
}

#[test]
fn a_circle_hidden_behind_the_root_is_found() {
    let files = [
        (
            "lib.rs",
            "mod apple;\nmod branch;\npub use {apple::Apple, branch::Branch};\n",
        ),
        ("apple.rs", "use crate::Branch;\npub struct Apple;\n"),
        ("branch.rs", "use crate::{Apple};\npub struct Branch;\n"),
    ];
    assert_eq!(drawn(&files), ["apple > branch : 1", "branch > apple : 1"]);
    assert_eq!(number_of_circles(&files), 1);
}

#[test]
fn a_child_may_use_its_parent_until_the_parent_uses_the_child() {
    let additive = [
        ("lib.rs", "mod camera;\npub use camera::Camera;\n"),
        ("camera.rs", "mod json;\npub struct Camera;\n"),
        (
            "camera/json.rs",
            "use super::Camera;\nimpl Camera { pub fn read() {} }\n",
        ),
    ];
    assert_eq!(drawn(&additive), ["camera::json > camera : 1"]);
    assert_eq!(number_of_circles(&additive), 0);

    let mut circular = additive;
    circular[1].1 = "mod json;\npub use json::Form;\npub struct Camera;\n";
    circular[2].1 = "use super::Camera;\npub struct Form(Camera);\n";
    assert_eq!(number_of_circles(&circular), 1);
}

#[test]
fn paths_count_wherever_they_stand() {
    let files = [
        (
            "lib.rs",
            "mod a;\nmod b;\nmod c;\nmod d;\nmod e;\nmod f;\nmod g;\n",
        ),
        (
            "a.rs",
            "use crate::b;\nfn f() -> usize {\n    b::size()\n}\nfn g() { format!(\"{}\", crate::c::NAME); }\n\
             #[serde(with = \"crate::d::form\")]\nstruct S { e: super::e::E }\n\
             impl<T> From<T> for S where T: super::f::F {}\nfn h() { <u8 as crate::g::G>::call(); }\n",
        ),
        ("b.rs", "pub fn size() -> usize { 0 }\n"),
        ("c.rs", "pub const NAME: &str = \"\";\n"),
        ("d.rs", "pub fn form() {}\n"),
        ("e.rs", "pub struct E;\n"),
        ("f.rs", "pub trait F {}\n"),
        ("g.rs", "pub trait G { fn call(); }\n"),
    ];
    assert_eq!(
        drawn(&files),
        [
            "a > b : 3",
            "a > c : 5",
            "a > d : 6",
            "a > e : 7",
            "a > f : 8",
            "a > g : 9"
        ]
    );
}

#[test]
fn tests_and_other_crates_are_left_out() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\n"),
        (
            "a.rs",
            "use std::{fmt, b::X};\nuse ::b::Y;\nfn f() { ::b::size(); T::b(); x.b(); }\n\
             #[cfg(test)]\nuse crate::b::{B};\n#[cfg(all(test, unix))]\nconst C: [u8; { crate::b::N }] = [];\n\
             #[test]\nfn t() { crate::b::size(); }\n#[cfg(test)]\nmod tests { use crate::b::B; }\n\
             #[cfg(test)]\nmod more;\n",
        ),
        (
            "b.rs",
            "#[cfg(not(test))]\nuse crate::a::f;\npub fn size() {}\npub struct B;\n",
        ),
    ];
    assert_eq!(drawn(&files), ["b > a : 2"]);
}

#[test]
fn a_module_and_a_function_may_have_one_name() {
    let files = [
        ("lib.rs", "mod apple;\nmod user;\n"),
        (
            "apple.rs",
            "mod peel;\npub fn apple() {}\npub use peel::peel;\n",
        ),
        ("apple/peel.rs", "pub fn peel() {}\npub struct Peel;\n"),
        (
            "user.rs",
            "use crate::apple::{apple, peel};\nfn f() { apple(); peel(); }\n",
        ),
    ];
    assert_eq!(
        drawn(&files),
        [
            "apple > apple::peel : 3",
            "user > apple : 1",
            "user > apple::peel : 1"
        ]
    );
}

#[test]
fn a_module_in_the_file_of_another_counts_as_that_file() {
    let files = [
        (
            "main.rs",
            "mod inner {\n    pub struct A;\n    pub mod deep {\n        use super::*;\n        fn f(a: A) { crate::other::g() }\n    }\n}\n\
             mod other;\nuse inner::deep;\nfn main() { deep::f() }\n",
        ),
        ("other.rs", "use crate::inner::deep::*;\npub fn g() {}\n"),
    ];
    assert_eq!(drawn(&files), ["crate > other : 5", "other > crate : 1"]);
}

#[test]
fn a_longer_circle_is_told_once_and_in_full() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\nmod c;\nmod d;\n"),
        ("a.rs", "pub fn f() { crate::b::f() }\n"),
        ("b.rs", "pub fn f() { crate::c::f() }\n"),
        ("c.rs", "pub fn f() { crate::a::f(); crate::d::f() }\n"),
        ("d.rs", "pub fn f() {}\n"),
    ];
    let tree = tree(&files);
    let arrows = arrows(&tree);
    let found = circles(&arrows);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].len(), 3);
    assert_eq!(
        on_circles(&arrows).len(),
        3,
        "the arrow to `d` lies on none"
    );
}

#[test]
fn re_exports_in_a_ring_come_to_an_end() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\n"),
        ("a.rs", "pub use crate::b::*;\npub use crate::b::X;\n"),
        ("b.rs", "pub use crate::a::*;\npub use crate::a::X;\n"),
    ];
    assert_eq!(number_of_circles(&files), 1);
}

#[test]
fn public_items_are_counted_and_fields_are_not() {
    let files = [(
        "lib.rs",
        "mod a { pub struct S { pub x: u8 }\npub(crate) fn no() {}\nfn none() {}\n\
         impl S { pub const N: u8 = 0; pub const fn f() {} }\npub unsafe extern \"C\" fn g() {}\n\
         pub struct T(pub u8);\npub static X: u8 = 0;\n}\npub use a::{S, T};\n",
    )];
    let tree = tree(&files);
    assert_eq!((tree.public_items(), tree.exports()), (6, 2));
}
