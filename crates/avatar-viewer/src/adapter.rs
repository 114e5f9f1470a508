//! What to do where there is nothing to draw with.

use anyhow::{Error, anyhow};
use avatar_render::headless::NoAdapter;

/// Variables of the Vulkan loader that name the only drivers that it looks at.
const ONLY_DRIVERS: [&str; 2] = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"];

/// The error, with what to install where no adapter was found.
pub(crate) fn explained(error: NoAdapter) -> Error {
    if !matches!(error, NoAdapter::NotFound { .. }) {
        return error.into();
    }
    let named = ONLY_DRIVERS.iter().find_map(|name| Some((*name, std::env::var_os(name)?)));
    let named = named.map(|(name, value)| format!("{name}={}", value.to_string_lossy()));
    anyhow!("{error}\n{}", advice(std::env::consts::OS, named.as_deref()))
}

/// What to do on this system; `named` is the variable that names the only drivers, with its value.
fn advice(system: &str, named: Option<&str>) -> String {
    match (system, named) {
        ("macos" | "ios", _) => {
            "Pictures are drawn with Metal, which is a part of macOS: there is nothing to install. \
            A virtual machine has no Metal unless it is given a graphics device."
                .to_owned()
        }
        ("windows", _) => {
            "Pictures are drawn with DirectX 12 or Vulkan: install the driver of your graphics card, by \
            Windows Update or from its maker (AMD, Intel, NVIDIA). Without a card Windows draws in software; \
            where that is missing, Windows Update brings it."
                .to_owned()
        }
        (_, Some(named)) => format!(
            "{named} names the only Vulkan drivers that are looked at: unset it, or name a driver's file.\n{LINUX}"
        ),
        (_, None) => LINUX.to_owned(),
    }
}

/// Packages with the driver that draws in software, which is enough, and with those of the usual cards, where
/// they are one.
const LINUX: &str = "Where a Vulkan driver is missing, install that of your graphics card, or Mesa's, which can draw without a card:
    Debian, Ubuntu, Mint   apt install mesa-vulkan-drivers
    Fedora                 dnf install mesa-vulkan-drivers vulkan-loader
    Arch, Manjaro          pacman -S vulkan-swrast vulkan-icd-loader (cards: vulkan-radeon, vulkan-intel, nvidia-utils)
    openSUSE               zypper install libvulkan_lvp libvulkan1
    Alpine                 apk add mesa-vulkan-swrast vulkan-loader
    others                 Mesa's driver \"lavapipe\" and the Vulkan loader, libvulkan.so.1";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_system_has_its_own_advice() {
        for (system, named, part) in [
            ("linux", None, "apt install mesa-vulkan-drivers"),
            ("freebsd", None, "libvulkan.so.1"),
            ("linux", Some("VK_DRIVER_FILES=/none"), "VK_DRIVER_FILES=/none names the only Vulkan drivers"),
            ("macos", Some("VK_DRIVER_FILES=/none"), "nothing to install"),
            ("windows", None, "Windows Update"),
        ] {
            let told = advice(system, named);
            assert!(told.contains(part), "{system}: {told}");
        }
    }
}
