use crate::Pack;
use avatar_look::Wrinkle;
use glam::Vec3;

impl Pack {
    /// Where which shapes wrinkle the skin, as `shapes.toml` says; nothing without that file.
    pub fn wrinkles(&self) -> Vec<Wrinkle> {
        let places = self.further_shapes().map_or(&[][..], |list| &list.wrinkles);
        let number = |name: &String| self.shapes().iter().position(|shape| shape == name);
        let wrinkle = |place: &crate::WrinklePlace| Wrinkle {
            center: Vec3::from(place.center),
            radius: place.radius,
            shapes: place.of.iter().filter_map(|(name, gain)| Some((number(name)?, *gain))).collect(),
        };
        places.iter().map(wrinkle).collect()
    }
}
