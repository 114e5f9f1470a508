//! FBX as text becomes FBX as bytes, version 7.4: only what the tests' own file uses of it.

/// A node: its name, properties as they are encoded, and what lies in it.
struct Node {
    name: String,
    properties: Vec<Vec<u8>>,
    children: Vec<Node>,
}

/// The bytes of a text of names, colons, values and braces.
pub(crate) fn binary(text: &str) -> Vec<u8> {
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim_start().starts_with(';')).collect();
    let text = lines.join("\n");
    let mut words = words(&text).into_iter().peekable();
    let nodes = nodes(&mut words);
    let mut out = b"Kaydara FBX Binary  \0\x1a\0".to_vec();
    out.extend(7400u32.to_le_bytes());
    nodes.iter().for_each(|node| write(node, &mut out));
    out.extend([0; 13]);
    out
}

fn words(text: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '"' => rest[1..].find('"').map_or(rest.len(), |end| end + 2),
            '{' | '}' | ',' => 1,
            _ => rest.find(|c: char| c.is_whitespace() || "{},\"".contains(c)).unwrap_or(rest.len()),
        };
        words.push(&rest[..length]);
        rest = rest[length..].trim_start();
    }
    words
}

type Words<'a> = std::iter::Peekable<std::vec::IntoIter<&'a str>>;

fn nodes(words: &mut Words<'_>) -> Vec<Node> {
    let mut nodes = Vec::new();
    while let Some(word) = words.next_if(|word| *word != "}") {
        let mut node =
            Node { name: word.trim_end_matches(':').to_owned(), properties: vec![], children: vec![] };
        while let Some(word) = words.next_if(|word| !word.ends_with(':') && !"{}".contains(word)) {
            match word {
                "," => {}
                word if word.starts_with('*') => node.properties.push(array(words)),
                word => node.properties.push(value(word)),
            }
        }
        if words.next_if(|word| *word == "{").is_some() {
            node.children = self::nodes(words);
            words.next();
        }
        nodes.push(node);
    }
    nodes
}

/// `{ a: 1,2,3 }`.
fn array(words: &mut Words<'_>) -> Vec<u8> {
    let inside: Vec<&str> = words.by_ref().take_while(|word| *word != "}").collect();
    let numbers: Vec<&str> = inside.into_iter().filter(|word| !["{", "a:", ","].contains(word)).collect();
    let whole: Result<Vec<i32>, _> = numbers.iter().map(|number| number.parse()).collect();
    let (kind, bytes): (u8, Vec<u8>) = match whole {
        Ok(whole) => (b'i', whole.iter().flat_map(|number| number.to_le_bytes()).collect()),
        Err(_) => {
            let real = numbers.iter().map(|number| number.parse::<f64>().unwrap_or(0.0));
            (b'd', real.flat_map(f64::to_le_bytes).collect())
        }
    };
    let mut out = vec![kind];
    for word in [numbers.len(), 0, bytes.len()] {
        out.extend((word as u32).to_le_bytes());
    }
    out.extend(bytes);
    out
}

fn value(word: &str) -> Vec<u8> {
    let of = |kind: u8, bytes: &[u8]| [&[kind][..], bytes].concat();
    match (word.strip_prefix('"'), word.parse::<i64>(), word.parse::<f64>()) {
        (Some(text), ..) => {
            let text = text.trim_end_matches('"');
            // The kind of a thing stands behind its name.
            let text = match text.split_once("::") {
                Some((kind, name)) => format!("{name}\0\x01{kind}"),
                None => text.to_owned(),
            };
            of(b'S', &[&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat())
        }
        (None, Ok(whole), _) => of(b'L', &whole.to_le_bytes()),
        (None, _, Ok(real)) => of(b'D', &real.to_le_bytes()),
        _ => of(b'C', &[u8::from(word == "Y")]),
    }
}

fn write(node: &Node, out: &mut Vec<u8>) {
    let start = out.len();
    let properties = node.properties.concat();
    for word in [0, node.properties.len(), properties.len()] {
        out.extend((word as u32).to_le_bytes());
    }
    out.push(node.name.len() as u8);
    out.extend(node.name.as_bytes());
    out.extend(properties);
    node.children.iter().for_each(|child| write(child, out));
    if !node.children.is_empty() {
        out.extend([0; 13]);
    }
    let end = out.len() as u32;
    out[start..start + 4].copy_from_slice(&end.to_le_bytes());
}
