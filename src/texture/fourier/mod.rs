//! Fourier textures: a few waves whose phases disturb one another, which look like leaves, rock, bark or pasture.
//!
//! Gardner ("Simulation of natural scenes using textured quadric surfaces", SIGGRAPH 1984; "Visual simulation of
//! clouds", 1985) multiplies two short series, Zaharia ("Procedural modeling of natural phenomena", section 2.4) adds
//! them. With terms `i = 0, 1, ...`, an offset `A` and a coupling `k` of the phases,
//!
//! ```text
//! X(x, y, z) = sum c_i (cos(w_i x + p_i + k pi/2 sin(w_(i-1) y) + k pi sin(w_i z / 2)) + A)
//! Y(x, y, z) = sum c_i (cos(w_i y + q_i + k pi/2 sin(w_(i-1) x) + k pi sin(w_i z / 2)) + A)
//! G = X Y (Gardner)   or   X + Y (Zaharia)
//! w_(i+1) = 2 w_i,   c_(i+1) = c_i / sqrt 2,   w_0 = 12,  c_0 = 1.76,  A = 1
//! ```
//!
//! Zaharia's print has `w_(i+1) = w_i` and `c_(i+1) = c_i sqrt 2`, which neither is a Fourier series nor stays bounded:
//! this is Gardner's recursion. The first term has none below it and is coupled to `w_0`. `p_i` and `q_i` come from the
//! seed.
//!
//! Every cosine lies in -1..1, so with `C = sum c_i` both series lie in `C (A - 1) ..= C (A + 1)`, which bounds `G`;
//! the value is `G` brought from these bounds to 0..1. The sum's value does not depend on `A` nor `c_0`; the product's
//! does: the smaller `A`, the darker the ground and the fewer and brighter its spots. Thresholds are better chosen by
//! the share of the texture that shall lie above them: see [`FourierWaves::threshold_above`].

mod settings;
mod threshold;
mod waves;

pub use settings::{Combination, FourierTexture, TERMS_LIMIT};
pub use threshold::threshold_above;
pub use waves::FourierWaves;
