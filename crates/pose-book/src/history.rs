/// Earlier and later texts, each with the name of the edit between it and the next one.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    pub(crate) text: String,
    undo: Vec<(String, String)>,
    redo: Vec<(String, String)>,
}

/// How many edits can be undone: a text is kept for each.
const KEPT: usize = 200;

impl History {
    pub(crate) fn new(text: String) -> Self {
        Self { text, ..Self::default() }
    }

    pub(crate) fn push(&mut self, edit: String, text: String) {
        self.redo.clear();
        self.undo.push((edit, std::mem::replace(&mut self.text, text)));
        if self.undo.len() > KEPT {
            self.undo.remove(0);
        }
    }

    pub(crate) fn can_undo(&self) -> Option<&str> {
        self.undo.last().map(|(edit, _)| edit.as_str())
    }

    pub(crate) fn can_redo(&self) -> Option<&str> {
        self.redo.last().map(|(edit, _)| edit.as_str())
    }

    pub(crate) fn undo(&mut self) -> Option<String> {
        let (edit, text) = self.undo.pop()?;
        self.redo.push((edit.clone(), std::mem::replace(&mut self.text, text)));
        Some(edit)
    }

    pub(crate) fn redo(&mut self) -> Option<String> {
        let (edit, text) = self.redo.pop()?;
        self.undo.push((edit.clone(), std::mem::replace(&mut self.text, text)));
        Some(edit)
    }
}
