//! The built-in face is part of the library, with the feature `default-face`: a changed file of it makes a
//! new library.

fn main() {
    println!("cargo::rerun-if-changed=../../assets/marsienne");
}
