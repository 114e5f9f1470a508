//! Material libraries of OBJ files.

use super::ObjFile;
use crate::build::path::beside;
use crate::build::text::{at_line, decode, float, shown};
use crate::scene::{AlphaMode, Finding, ImportError, Material, Note, Resolve, SceneImage, TextureRef, Wrap};
use std::collections::{BTreeMap, HashMap};

/// Options of texture statements and how many words follow them; `-o`, `-s` and `-t` take up to three
/// numbers.
const OPTIONS: [(&str, usize); 9] = [
    ("-blendu", 1),
    ("-blendv", 1),
    ("-bm", 1),
    ("-boost", 1),
    ("-cc", 1),
    ("-clamp", 1),
    ("-imfchan", 1),
    ("-mm", 2),
    ("-texres", 1),
];

/// As many statements that are not read are named in a note.
const MAX_LEFT_OUT: usize = 32;

/// Materials by name, and what they have beside what [`Material`] can tell yet.
#[derive(Default)]
struct Library {
    found: HashMap<String, usize>,
    materials: Vec<Draft>,
}

#[derive(Default)]
struct Draft {
    material: Material,
    /// A height map, or a normal map under its statement, which is the usual use of it.
    bump: Option<TextureRef>,
    /// The multiplier of the bump map, `-bm`: the strength of a normal map in its place.
    bump_scale: f32,
    /// The picture of its opacity.
    opacity: Option<usize>,
    /// Pictures of roughness and of metalness.
    roughness: Option<TextureRef>,
    metallic: Option<TextureRef>,
    /// Whether `Pr` was there, which counts more than `Ns`.
    has_roughness: bool,
    /// Whether `d` was there, which counts more than `Tr`: writers disagree about what that one means.
    has_opacity: bool,
}

/// Gives the parts of a file the materials that it names, in their order. What cannot be found gets a note.
pub(super) fn attach(
    obj: &mut ObjFile,
    names: &[String],
    libraries: &[String],
    resolve: &mut Resolve<'_>,
) -> Result<(), ImportError> {
    let mut library = Library::default();
    let mut read = std::collections::HashSet::new();
    for path in libraries.iter().flat_map(|line| paths(line)) {
        if !read.insert(path.clone()) {
            continue;
        }
        match resolve(&path) {
            Ok(bytes) => {
                parse(&mut library, obj, &path, &decode(&bytes)).map_err(|error| error.in_file(&path))?;
            }
            Err(reason) => {
                let text = format!("the material library could not be read: {reason}");
                obj.notes.push(Note::new(path, Finding::Missing(text)));
            }
        }
    }
    for name in names {
        let material = match library.found.get(name).and_then(|&index| library.materials.get(index)) {
            Some(draft) => draft.material(&mut |finding| {
                obj.notes.push(Note::new(format!("material {name:?}"), finding));
            }),
            None => {
                let text = "is in no library: it gets default values";
                obj.notes.push(Note::new(format!("material {name:?}"), Finding::missing(text)));
                Material { name: name.clone(), metallic: 0.0, double_sided: true, ..Material::default() }
            }
        };
        obj.materials.push(material);
    }
    keep_used_images(obj);
    for image in obj.images.iter_mut() {
        match resolve(&image.name) {
            Ok(bytes) => {
                image.mime = mime(&bytes).to_owned();
                image.bytes = bytes;
            }
            Err(reason) => {
                let text = format!("the image could not be read: {reason}");
                obj.notes.push(Note::new(image.name.as_str(), Finding::Missing(text)));
            }
        }
    }
    Ok(())
}

impl Draft {
    /// The material that all statements together make.
    fn material(&self, note: &mut impl FnMut(Finding)) -> Material {
        let mut material = self.material.clone();
        let of_color = material.base_color_texture.map(|texture| texture.image);
        // The opacity of the picture that is its colour as well is that picture's alpha.
        if self.opacity.is_some() && self.opacity == of_color {
            material.alpha_mode = AlphaMode::Blend;
        } else if self.opacity.is_some() {
            note(Finding::left_out("its opacity texture is left out"));
        }
        if let (None, Some(bump)) = (material.normal_texture, self.bump) {
            note(Finding::converted("its bump map is taken for a normal map"));
            (material.normal_texture, material.normal_scale) = (Some(bump), self.bump_scale);
        }
        // A colour is a factor on its texture; that of black would never be seen, and exporters that know the
        // one or the other write it.
        let [r, g, b, _] = &mut material.base_color;
        if material.base_color_texture.is_some() && [*r, *g, *b] == [0.0; 3] {
            note(Finding::mended("its colour Kd is black and would hide its texture: white is taken"));
            [*r, *g, *b] = [1.0; 3];
        }
        // Also where there is no Ke, as it is in most files.
        if material.emissive_texture.is_some() && material.emissive == [0.0; 3] {
            material.emissive = [1.0; 3];
        }
        self.roughness(&mut material, note);
        material
    }

    /// Pictures of one channel, which have the same value in all: the material takes roughness from green and
    /// metalness from blue of one picture, so that it can be one for roughness where nothing is metal, or one
    /// for both.
    fn roughness(&self, material: &mut Material, note: &mut impl FnMut(Finding)) {
        match (self.roughness, self.metallic) {
            (None, None) => {}
            (Some(rough), Some(metal)) if rough.image == metal.image => {
                material.metallic_roughness_texture = Some(rough);
                (material.roughness, material.metallic) = (1.0, 1.0);
            }
            (Some(rough), metal) if material.metallic == 0.0 => {
                material.metallic_roughness_texture = Some(rough);
                material.roughness = 1.0;
                if metal.is_some() {
                    note(Finding::left_out("its metalness texture is left out"));
                }
            }
            (rough, metal) => {
                for (texture, what) in [(rough, "roughness"), (metal, "metalness")] {
                    if texture.is_some() {
                        note(Finding::LeftOut(format!("its {what} texture is left out")));
                    }
                }
            }
        }
    }
}

/// A line may name several libraries, or one whose name contains spaces.
fn paths(line: &str) -> Vec<String> {
    let words = || line.split_whitespace();
    let each_is_a_library = words().all(|word| word.to_ascii_lowercase().ends_with(".mtl"));
    if each_is_a_library { words().filter_map(beside).collect() } else { beside(line).into_iter().collect() }
}

fn mime(bytes: &[u8]) -> &'static str {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => "image/png",
        [0xff, 0xd8, 0xff, ..] => "image/jpeg",
        _ => "",
    }
}

fn parse(library: &mut Library, obj: &mut ObjFile, path: &str, text: &str) -> Result<(), ImportError> {
    let mut current = None;
    let mut images: HashMap<String, usize> =
        obj.images.iter().enumerate().map(|(index, image)| (image.name.clone(), index)).collect();
    let mut left_out: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    for (row, text) in text.lines().enumerate() {
        let line = row + 1;
        let text = text.trim();
        let (keyword, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let rest = rest.trim();
        if keyword.is_empty() || keyword.starts_with('#') {
            continue;
        }
        if keyword == "newmtl" {
            library.found.entry(rest.to_owned()).or_insert(library.materials.len());
            let material =
                Material { name: rest.to_owned(), metallic: 0.0, double_sided: true, ..Material::default() };
            library.materials.push(Draft { material, ..Draft::default() });
            current = library.materials.last_mut();
            continue;
        }
        let Some(draft) = &mut current else {
            return Err(at_line(line, "newmtl before anything else", shown(keyword)));
        };
        let material = &mut draft.material;
        let one = |what| float(line, what, rest.split_whitespace().next());
        let mut image = |images: &mut HashMap<String, usize>| texture(obj, images, path, line, rest);
        match keyword {
            "Kd" => color(line, rest, &mut material.base_color[..3])?,
            "Ke" => color(line, rest, &mut material.emissive)?,
            "d" => {
                // `d -halo` depends on the angle of sight.
                let word = rest.split_whitespace().find(|word| *word != "-halo");
                opacity(material, float(line, "an opacity", word)?);
                draft.has_opacity = true;
            }
            "Tr" if !draft.has_opacity => opacity(material, 1.0 - one("a transparency")?),
            "Ns" if draft.has_roughness => {
                one("an exponent")?;
            }
            // Of the same width: B. Karis, "Specular BRDF Reference" (2013), α² = 2 / (n + 2) with α the
            // roughness squared.
            "Ns" => material.roughness = (2.0 / (one("an exponent")?.max(0.0) + 2.0)).sqrt().sqrt(),
            "Pr" => {
                material.roughness = one("a roughness")?.clamp(0.0, 1.0);
                draft.has_roughness = true;
            }
            "Pm" => material.metallic = one("a metalness")?.clamp(0.0, 1.0),
            "map_Kd" => material.base_color_texture = image(&mut images),
            "map_Ke" => material.emissive_texture = image(&mut images),
            "map_d" => draft.opacity = image(&mut images).map(|texture| texture.image),
            "map_Pr" => draft.roughness = image(&mut images),
            "map_Pm" => draft.metallic = image(&mut images),
            "norm" | "map_norm" | "map_Kn" => material.normal_texture = image(&mut images),
            "bump" | "map_bump" | "map_Bump" => {
                draft.bump = image(&mut images);
                draft.bump_scale = multiplier(rest);
            }
            // What `d` says counts more.
            "Tr" => {}
            _ if says_nothing(keyword, rest) => {}
            _ => {
                if left_out.len() < MAX_LEFT_OUT || left_out.contains_key(keyword) {
                    left_out.entry(keyword).or_insert((0, line)).0 += 1;
                }
            }
        }
    }
    if let Some(first) = left_out.values().map(|(_, line)| *line).min() {
        let names: Vec<String> =
            left_out.iter().map(|(name, (count, _))| format!("{} ({count})", shown(name))).collect();
        let text =
            format!("statements that surfaces here have no term for are left out: {}", names.join(", "));
        obj.notes.push(Note::new(format!("{path}, line {first}"), Finding::LeftOut(text)));
    }
    Ok(())
}

/// Whether a statement that is not read is as if it were not there: no reflected, ambient or filtered colour,
/// no refraction, no sheen or clear coat; `illum` chooses among formulas that are not used here, of which 0
/// to 2 need nothing that the others say.
fn says_nothing(keyword: &str, rest: &str) -> bool {
    let are_all = |value: f32| {
        let mut words = rest.split_whitespace().map(str::parse::<f32>).peekable();
        words.peek().is_some() && words.all(|word| word == Ok(value))
    };
    match keyword {
        "Ka" | "Ks" | "Ps" | "Pc" | "Pcr" | "aniso" | "anisor" => are_all(0.0),
        "Ni" | "Tf" => are_all(1.0),
        "illum" => are_all(0.0) || are_all(1.0) || are_all(2.0),
        _ => false,
    }
}

/// The number behind `-bm`, else 1.
fn multiplier(rest: &str) -> f32 {
    let mut words = rest.split_whitespace();
    let value = words.find(|word| word.eq_ignore_ascii_case("-bm")).and_then(|_| words.next());
    value.and_then(|word| word.parse().ok()).filter(|scale: &f32| scale.is_finite()).unwrap_or(1.0)
}

fn opacity(material: &mut Material, opacity: f32) {
    material.base_color[3] = opacity.clamp(0.0, 1.0);
    material.alpha_mode = if opacity < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque };
}

/// One number counts for all three. Spectra and CIE colours are left as they were.
fn color(line: usize, rest: &str, color: &mut [f32]) -> Result<(), ImportError> {
    if rest.starts_with(|c: char| c.is_ascii_alphabetic()) {
        return Ok(());
    }
    let words: Vec<&str> = rest.split_whitespace().take(color.len()).collect();
    for (channel, value) in color.iter_mut().enumerate() {
        *value = float(line, "a colour", words.get(channel).or(words.first()).copied())?;
    }
    Ok(())
}

/// The image that a texture statement names after its options.
fn texture(
    obj: &mut ObjFile,
    images: &mut HashMap<String, usize>,
    library: &str,
    line: usize,
    rest: &str,
) -> Option<TextureRef> {
    let mut rest = rest;
    let mut moved = false;
    let mut wrap = [Wrap::Repeat; 2];
    let split = |text: &str| -> (usize, usize) {
        let end = text.find(char::is_whitespace).unwrap_or(text.len());
        (end, text.len() - text[end..].trim_start().len())
    };
    while rest.starts_with('-') {
        let (end, next) = split(rest);
        let option = rest[..end].to_ascii_lowercase();
        rest = &rest[next..];
        let known = OPTIONS.iter().find(|(name, _)| *name == option);
        let most = known.map_or(if option == "-type" { 1 } else { 3 }, |(_, words)| *words);
        moved |= ["-o", "-s", "-t"].contains(&option.as_str());
        if option == "-clamp" && rest[..split(rest).0].eq_ignore_ascii_case("on") {
            wrap = [Wrap::Clamp; 2];
        }
        for _ in 0..most {
            let (end, next) = split(rest);
            if known.is_none() && option != "-type" && rest[..end].parse::<f32>().is_err() {
                break;
            }
            rest = &rest[next..];
        }
    }
    if moved {
        let finding = Finding::left_out("where the texture lies is left out");
        obj.notes.push(Note::new(format!("{library}, line {line}"), finding));
    }
    let name = beside(rest)?;
    let image = *images.entry(name.clone()).or_insert_with(|| {
        obj.images.push(SceneImage { name, ..SceneImage::default() });
        obj.images.len() - 1
    });
    Some(TextureRef { wrap, ..TextureRef::from(image) })
}

/// Drops images that no material of the file shows; libraries are often shared by many files.
fn keep_used_images(obj: &mut ObjFile) {
    let mut places = vec![None; obj.images.len()];
    let mut kept = Vec::new();
    for material in &mut obj.materials {
        let slots = [
            &mut material.base_color_texture,
            &mut material.emissive_texture,
            &mut material.normal_texture,
            &mut material.metallic_roughness_texture,
        ];
        for TextureRef { image, .. } in slots.into_iter().flatten() {
            *image = *places[*image].get_or_insert_with(|| {
                kept.push(std::mem::take(&mut obj.images[*image]));
                kept.len() - 1
            });
        }
    }
    obj.images = kept;
}
