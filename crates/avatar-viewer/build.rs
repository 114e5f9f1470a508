//! The built-in avatar is part of the program: a changed file of it makes a new program.

fn main() {
    println!("cargo::rerun-if-changed=../../assets/marsienne");
}
