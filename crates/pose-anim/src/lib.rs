//! Controls, poses and smooth transitions for rigged faces.
