//! Meshes: primitives with several indices for each corner.

use super::Reader;
use super::source::{Input, Source, inputs};
use super::xml::At;
use crate::build::corners::{Corner, Corners};
use crate::build::polygon::Cutter;
use crate::build::srgb::linear;
use crate::scene::{Finding, ImportError};
use glam::{Vec2, Vec3, Vec4};
use std::rc::Rc;

/// A `<geometry>`.
#[derive(Debug, Default)]
pub(super) struct Geometry {
    /// Positions.
    pub(super) points: Vec<Vec3>,
    /// What is drawn of it.
    pub(super) primitives: Vec<Primitive>,
}

/// Triangles of one material.
#[derive(Debug)]
pub(super) struct Primitive {
    /// The name that instances bind materials to.
    pub(super) material: String,
    pub(super) corners: Corners,
    /// The file's numbers of its sets of texture coordinates, in the order of the mesh's.
    pub(super) uv_sets: Vec<usize>,
}

/// What the inputs of a primitive mean.
struct Layout {
    /// Indices for one corner.
    stride: usize,
    point: usize,
    points: Rc<Source>,
    normal: Option<(usize, Rc<Source>)>,
    uv: Option<(usize, Rc<Source>)>,
    uv_1: Option<(usize, Rc<Source>)>,
    color: Option<(usize, Rc<Source>)>,
    /// The file's numbers of the two sets.
    uv_sets: Vec<usize>,
}

impl<'a> Reader<'a> {
    /// Reads a geometry, or finds it as read before.
    pub(super) fn geometry(&mut self, at: At<'a>) -> Result<Rc<Geometry>, ImportError> {
        if let Some(known) = self.geometries.get(&at.number) {
            return Ok(known.clone());
        }
        let geometry = Rc::new(self.read_geometry(at)?);
        self.geometries.insert(at.number, geometry.clone());
        Ok(geometry)
    }

    fn read_geometry(&mut self, at: At<'a>) -> Result<Geometry, ImportError> {
        let mut geometry = Geometry::default();
        let Some(mesh) = at.child("mesh") else {
            self.note(at, Finding::left_out("only meshes are read; this geometry is left out"));
            return Ok(geometry);
        };
        let Some(vertices) = mesh.child("vertices") else { return Ok(geometry) };
        let Some(points) = self.source_of(vertices, "POSITION")? else {
            return Err(vertices.error("an input POSITION", "none"));
        };
        self.take(at, points.count)?;
        geometry.points = (0..points.count).map(|point| vec3(points.item(point))).collect();
        for primitive in mesh.children() {
            match primitive.name() {
                "triangles" | "polylist" | "polygons" | "tristrips" | "trifans" => {
                    let material = primitive.attribute("material").unwrap_or("").to_owned();
                    let (corners, uv_sets) = self.primitive(primitive, vertices, &geometry.points)?;
                    geometry.primitives.push(Primitive { material, corners, uv_sets });
                }
                "lines" | "linestrips" => self.note(primitive, Finding::left_out("lines are left out")),
                _ => {}
            }
        }
        Ok(geometry)
    }

    fn layout(&mut self, at: At<'a>, vertices: At<'a>) -> Result<Option<Layout>, ImportError> {
        let own = inputs(at)?;
        let Some(vertex) = own.iter().find(|input| input.semantic == "VERTEX").map(|input| input.offset)
        else {
            return Ok(None);
        };
        let stride = own.iter().map(|input| input.offset + 1).max().unwrap_or(1);
        // What belongs to vertices follows their index.
        let shared = inputs(vertices)?.into_iter().map(|input| Input { offset: vertex, ..input });
        let all: Vec<Input<'a>> = own.into_iter().chain(shared).collect();
        let mut uvs: Vec<&Input<'a>> = all.iter().filter(|input| input.semantic == "TEXCOORD").collect();
        uvs.sort_by_key(|input| input.set);
        if uvs.len() > 2 {
            let text = format!("{} further sets of texture coordinates are left out", uvs.len() - 2);
            self.note(at, Finding::LeftOut(text));
        }
        let mut colors: Vec<&Input<'a>> = all.iter().filter(|input| input.semantic == "COLOR").collect();
        colors.sort_by_key(|input| input.set);
        if colors.len() > 1 {
            let text = format!("{} further sets of colours are left out", colors.len() - 1);
            self.note(at, Finding::LeftOut(text));
        }
        let place = |input: Option<&&Input<'a>>| input.map(|input| (input.offset, input.source));
        let (uv, uv_1, color) = (place(uvs.first()), place(uvs.get(1)), place(colors.first()));
        let uv_sets = uvs.iter().take(2).map(|input| input.set).collect();
        let of = |semantic| {
            all.iter().find(|input| input.semantic == semantic).map(|input| (input.offset, input.source))
        };
        let mut open = |found: Option<(usize, At<'a>)>| {
            found.map(|(offset, source)| Ok((offset, self.source(source)?))).transpose()
        };
        let Some((point, points)) = open(of("POSITION"))? else { return Ok(None) };
        Ok(Some(Layout {
            stride,
            point,
            points,
            normal: open(of("NORMAL"))?,
            uv: open(uv)?,
            uv_1: open(uv_1)?,
            color: open(color)?,
            uv_sets,
        }))
    }

    /// The corners of a primitive, and the file's numbers of its sets of texture coordinates.
    fn primitive(
        &mut self,
        at: At<'a>,
        vertices: At<'a>,
        points: &[Vec3],
    ) -> Result<(Corners, Vec<usize>), ImportError> {
        let mut corners = Corners::default();
        let Some(layout) = self.layout(at, vertices)? else {
            self.note(at, Finding::left_out("a primitive without vertices is left out"));
            return Ok((corners, Vec::new()));
        };
        let holes = at.all("ph").count();
        if holes > 0 {
            self.note(at, Finding::LeftOut(format!("holes of {holes} polygons are left out")));
        }
        let (budget, cutter) = (&mut self.budget, &mut self.cutter);
        let mut add = |corner: [Corner; 3]| {
            budget.take(3, 1).map_err(|exceeded| exceeded.at(at.place()))?;
            corners.triangle(corner);
            Ok(())
        };
        for list in at.all("p").chain(at.all("ph").filter_map(|polygon| polygon.child("p"))) {
            let read = layout.corners(list)?;
            match at.name() {
                "triangles" => read.as_chunks::<3>().0.iter().try_for_each(|three| add(*three))?,
                "trifans" => {
                    let last = read.len().saturating_sub(1);
                    (1..last).try_for_each(|k| add([read[0], read[k], read[k + 1]]))?;
                }
                // Every second one runs the other way around.
                "tristrips" => read.windows(3).enumerate().try_for_each(|(k, three)| {
                    let [a, b, c] = [three[0], three[1], three[2]];
                    add(if k % 2 == 0 { [a, b, c] } else { [b, a, c] })
                })?,
                "polygons" => polygon(&read, points, cutter, &mut add)?,
                _ => {
                    let counts: Vec<usize> =
                        at.child("vcount").map(|counts| counts.numbers()).transpose()?.unwrap_or_default();
                    let mut rest = &read[..];
                    for count in counts {
                        let Some((these, others)) = rest.split_at_checked(count) else {
                            return Err(
                                at.error(format!("{count} corners of a polygon"), rest.len().to_string())
                            );
                        };
                        polygon(these, points, cutter, &mut add)?;
                        rest = others;
                    }
                }
            }
        }
        if corners.lacks_normals() {
            self.note(at, Finding::mended("normals were computed"));
        }
        Ok((corners, layout.uv_sets))
    }
}

fn polygon(
    corners: &[Corner],
    points: &[Vec3],
    cutter: &mut Cutter,
    add: &mut impl FnMut([Corner; 3]) -> Result<(), ImportError>,
) -> Result<(), ImportError> {
    let positions: Vec<Vec3> = corners.iter().map(|corner| points[corner.point as usize]).collect();
    cutter.cut(&positions).into_iter().try_for_each(|triangle| add(triangle.map(|corner| corners[corner])))
}

impl Layout {
    /// The corners of a list of indices, each of which was checked.
    fn corners(&self, list: At<'_>) -> Result<Vec<Corner>, ImportError> {
        let indices: Vec<usize> = list.numbers()?;
        // Origin bottom left in COLLADA.
        let uv = |item: &[f64]| {
            let uv = vec3(Some(item));
            Vec2::new(uv.x, 1.0 - uv.y)
        };
        let corner = |indices: &[usize]| {
            let mut corner = Corner {
                point: item(list, &self.points, indices, self.point)?.0 as u32,
                ..Corner::default()
            };
            if let Some((offset, source)) = &self.normal {
                corner.normal = vec3(Some(item(list, source, indices, *offset)?.1)).try_normalize();
            }
            if let Some((offset, source)) = &self.uv {
                corner.uv = uv(item(list, source, indices, *offset)?.1);
            }
            if let Some((offset, source)) = &self.uv_1 {
                corner.uv_1 = Some(uv(item(list, source, indices, *offset)?.1));
            }
            if let Some((offset, source)) = &self.color {
                corner.color = Some(color(item(list, source, indices, *offset)?.1));
            }
            Ok(corner)
        };
        indices.chunks_exact(self.stride).map(corner).collect()
    }
}

/// The item of a source that a corner has, and its number.
fn item<'s>(
    list: At<'_>,
    source: &'s Source,
    indices: &[usize],
    offset: usize,
) -> Result<(usize, &'s [f64]), ImportError> {
    let index = indices.get(offset).copied().unwrap_or(0);
    let wrong = || list.error(format!("an index below {}", source.count), index.to_string());
    Ok((index, source.item(index).ok_or_else(wrong)?))
}

/// A colour of a vertex and, behind it, its opacity. Exporters write the colours of the screen, sRGB, as
/// Blender and three.js have it.
fn color(item: &[f64]) -> Vec4 {
    let opacity = item.get(3).map_or(1.0, |x| x.clamp(0.0, 1.0) as f32);
    Vec3::from(linear(vec3(Some(item)).to_array())).extend(opacity)
}

/// The first three numbers of an item; missing numbers are 0.
fn vec3(item: Option<&[f64]>) -> Vec3 {
    let at = |k: usize| item.and_then(|item| item.get(k)).map_or(0.0, |x| *x as f32);
    Vec3::new(at(0), at(1), at(2))
}
