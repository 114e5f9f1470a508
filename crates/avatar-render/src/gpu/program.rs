//! WGSL programs: modules of text, preceded by constants from Rust, so that each number is written once.

/// The value of a constant that Rust defines and WGSL reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value {
    /// `bool`.
    Flag(bool),
    /// `u32`.
    Count(u32),
    /// `i32`.
    Signed(i32),
    /// `f32`.
    Float(f32),
}

/// A constant of a program: its name in WGSL, and its value.
pub(crate) type Constant = (&'static str, Value);

/// A piece of WGSL; a program is several of them joined.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Module {
    pub(crate) text: &'static str,
    /// The constants that it needs from Rust. If several modules of a program need the same constant, only
    /// the one that the others build on lists it: WGSL forbids a second definition.
    pub(crate) constants: fn() -> Vec<Constant>,
}

/// A WGSL program: a pass and the modules that it calls.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Program {
    pub(crate) label: &'static str,
    /// Entry point of the vertex or compute stage.
    pub(crate) entry: &'static str,
    /// Entry point of the fragment stage, if there is one.
    pub(crate) fragment: Option<&'static str>,
    pub(crate) modules: &'static [Module],
}

impl Module {
    /// A module without constants of its own.
    pub(crate) const fn of(text: &'static str) -> Self {
        Self { text, constants: Vec::new }
    }
}

impl Program {
    /// The text of the whole program, with these modules behind its own. `choices` are the constants that
    /// depend on the renderer's configuration.
    pub(crate) fn source_with(&self, choices: &[Constant], more: &[Module]) -> String {
        let modules = || self.modules.iter().chain(more);
        let of_modules = modules().flat_map(|module| (module.constants)());
        let mut source: String = choices.iter().copied().chain(of_modules).map(declaration).collect();
        for module in modules() {
            source.push('\n');
            source.push_str(module.text);
        }
        source
    }

    /// Compiles the program for a device.
    pub(crate) fn compiled(&self, device: &wgpu::Device, choices: &[Constant]) -> wgpu::ShaderModule {
        self.compiled_with(device, choices, &[])
    }

    /// The same with these modules behind its own.
    pub(crate) fn compiled_with(
        &self,
        device: &wgpu::Device,
        choices: &[Constant],
        more: &[Module],
    ) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.label),
            source: wgpu::ShaderSource::Wgsl(self.source_with(choices, more).into()),
        })
    }
}

fn declaration((name, value): Constant) -> String {
    match value {
        Value::Flag(value) => format!("const {name}: bool = {value};\n"),
        Value::Count(value) => format!("const {name}: u32 = {value}u;\n"),
        Value::Signed(value) => format!("const {name}: i32 = {value};\n"),
        Value::Float(value) => format!("const {name}: f32 = {value:e};\n"),
    }
}
