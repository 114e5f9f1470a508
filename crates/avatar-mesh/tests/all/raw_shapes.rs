//! Further shapes as bytes: what is read is what was written, and damage is told with its place.

use avatar_mesh::raw_shapes::{RawShapesError, Reader, write};
use avatar_mesh::{Offsets, Shape};
use glam::Vec3;
use proptest::prelude::*;

/// Bytes by hand: two moved vertices of ten.
fn two_vertices() -> Vec<u8> {
    let mut bytes = 2u32.to_le_bytes().to_vec();
    for (vertex, numbers) in
        [(3u32, [1.0f32, 2.0, 3.0, 0.0, 0.0, 0.0]), (7, [0.0, 0.0, 0.0, -1.0, 0.5, 0.25])]
    {
        bytes.extend(vertex.to_le_bytes());
        bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    }
    bytes
}

fn read(bytes: &[u8], vertices: usize) -> Result<Shape, RawShapesError> {
    let mut reader = Reader::new(bytes);
    let shape = reader.read("pout", vertices)?;
    reader.finish()?;
    Ok(shape)
}

#[test]
fn the_layout_is_as_described() {
    let shape = read(&two_vertices(), 10).unwrap();
    assert_eq!(shape.name, "pout");
    assert_eq!(shape.positions.iter().collect::<Vec<_>>(), [(3, Vec3::new(1.0, 2.0, 3.0))]);
    let normals = shape.normals.as_ref().expect("normals");
    assert_eq!(normals.iter().collect::<Vec<_>>(), [(7, Vec3::new(-1.0, 0.5, 0.25))]);
    let mut written = Vec::new();
    write(&shape, &mut written);
    assert_eq!(written, two_vertices());
}

#[test]
fn damage_is_told_with_its_place() {
    let whole = two_vertices();
    let told = |bytes: &[u8], vertices| read(bytes, vertices).unwrap_err().to_string();
    for (bytes, vertices, text) in [
        (
            &whole[..2],
            10,
            r#"byte 0, shape "pout": expected 4 more bytes for its number of vertices, found 2"#,
        ),
        (
            &whole[..59],
            10,
            r#"byte 4, shape "pout": expected 56 more bytes for its moved vertices, found 55"#,
        ),
        (&whole, 7, r#"byte 32, shape "pout", record 1: expected a vertex from 4 to 6 (ascending), found 7"#),
    ] {
        assert_eq!(told(bytes, vertices), text);
    }
    let mut more = whole.clone();
    more.push(0);
    assert_eq!(
        told(&more, 10),
        "byte 60: expected the end of the file behind the last shape, found 1 more bytes"
    );
    let mut repeated = whole.clone();
    repeated[32] = 3;
    let text = r#"byte 32, shape "pout", record 1: expected a vertex from 4 to 9 (ascending), found 3"#;
    assert_eq!(told(&repeated, 10), text);
    let mut endless = whole.clone();
    // The first number of the second record's normal.
    endless[48..52].copy_from_slice(&f32::NAN.to_le_bytes());
    let text = r#"byte 48, shape "pout", vertex 7: expected a finite number in its normal offset, found NaN"#;
    assert_eq!(told(&endless, 10), text);
}

#[test]
fn a_count_beyond_the_file_takes_no_memory() {
    let bytes = u32::MAX.to_le_bytes();
    let mut error = None;
    let taken = allocation_counter::measure(|| error = read(&bytes, usize::MAX).err());
    let text = r#"byte 4, shape "pout": expected 120259084260 more bytes for its moved vertices, found 0"#;
    assert_eq!(error.expect("an error").to_string(), text);
    assert!(taken.bytes_max < 1000, "{} bytes", taken.bytes_max);
}

proptest! {
    #[test]
    fn what_is_read_is_what_was_written(
        moved in prop::collection::btree_map(0u32..200, (any::<[i16; 3]>(), any::<[i16; 3]>()), 0..80),
    ) {
        let vector = |numbers: [i16; 3]| Vec3::from_array(numbers.map(f32::from));
        let positions = moved.iter().map(|(vertex, (position, _))| (*vertex, vector(*position)));
        let normals = moved.iter().map(|(vertex, (_, normal))| (*vertex, vector(*normal)));
        let shape = Shape::new("pout", Offsets::from_pairs(200, positions).unwrap())
            .with_normals(Offsets::from_pairs(200, normals).unwrap());
        let mut bytes = Vec::new();
        write(&shape, &mut bytes);
        prop_assert_eq!(read(&bytes, 200).unwrap(), shape);
    }

    #[test]
    fn any_bytes_give_a_shape_or_an_error(bytes in prop::collection::vec(0u8..4, 0..200)) {
        if let Ok(shape) = read(&bytes, 10) {
            let mut written = Vec::new();
            write(&shape, &mut written);
            prop_assert_eq!(read(&written, 10).unwrap(), shape);
        }
    }
}
