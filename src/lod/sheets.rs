//! temporary
use super::{settings::*, *};
use crate::{texture::TextureData, tree::painting::paint};
use std::path::Path;
fn save(t: &TextureData, mip: usize, alpha: u8, name: &str) {
    let (w, h) = (t.width >> mip, t.height >> mip);
    let mut data = Vec::new();
    for p in t.mips[mip].chunks_exact(4) {
        // alpha 0: masked over sky; 1: as is; 2: alpha as grey; 3: rgb
        match alpha {
            0 => data.extend(if p[3] >= 128 { [p[0], p[1], p[2]] } else { [170, 195, 225] }),
            2 => data.extend([p[3]; 3]),
            _ => data.extend([p[0], p[1], p[2]]),
        }
    }
    let img = image::RgbImage::from_raw(w, h, data).unwrap();
    let k = (1024 / w.max(h)).max(1);
    let img = image::imageops::resize(&img, w * k, h * k, image::imageops::FilterType::Nearest);
    img.save(format!("/tmp/sheets/{name}.png")).unwrap();
}
#[test]
fn sheets() {
    std::fs::create_dir_all("/tmp/sheets").unwrap();
    for name in ["oak", "fir", "birch", "billows", "impression_summer", "hazel", "zaharia_oak"] {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/species").join(format!("{name}.species.ron"));
        let species = Species::from_ron(&std::fs::read_to_string(file).unwrap()).unwrap();
        let model = TreeModel::bake(&species, species.age.mature_years, 1);
        let textures = paint(&species);
        let cpu = || {
            std::time::Duration::from_nanos(
                std::fs::read_to_string("/proc/thread-self/schedstat")
                    .unwrap()
                    .split(' ')
                    .next()
                    .unwrap()
                    .parse()
                    .unwrap(),
            )
        };
        let start = cpu();
        let scene = Scene::new(&species, &model, &textures);
        let t0 = cpu() - start;
        let c = CylinderLevel::bake(&scene, &species, &model, &CylinderSettings::default());
        let t1 = cpu() - start;
        let v = ViewAtlas::bake(&scene, &ViewSettings::default());
        let t2 = cpu() - start;
        let r = simplify::reduce(&model, &LevelSettings::default().reductions[0]);
        let r1 = simplify::reduce(&model, &LevelSettings::default().reductions[1]);
        let t3 = cpu() - start;
        println!(
            "{name}: wood {} leaves {} scene {t0:?} cylinder {:?} views {:?} reduce {:?}",
            model.wood.indices.len() / 3,
            model.leaves.indices.len() / 3,
            t1 - t0,
            t2 - t1,
            t3 - t2
        );
        println!(
            "  reduced wood {} {} leaves {} {}",
            r.wood.indices.len() / 3,
            r1.wood.indices.len() / 3,
            r.leaves.indices.len() / 3,
            r1.leaves.indices.len() / 3
        );
        let t4 = cpu();
        let mut n = 0;
        for view in [[0u32, 3], [2, 2], [5, 1], [3, 4]] {
            let basis = ViewBasis::of_view(view.into(), 8);
            let half = v.frame.half_m(&basis);
            for y in 0..128 {
                for x in 0..128 {
                    let (px, py) = ((x as f32 + 0.5) / 64.0 - 1.0, (y as f32 + 0.5) / 64.0 - 1.0);
                    let from = v.frame.centre + basis.right * (px * half.x)
                        - basis.up * (py * half.y)
                        - basis.forward * half.z;
                    n += scene.cast(from, basis.forward, 2.0 * half.z, scene::Sight::Tree).is_some() as usize;
                }
            }
        }
        println!("  4 views by rays: {:?} hits {n}; {} faces", cpu() - t4, v.colour.mips.len());
        let t5 = cpu();
        let mut pr = projection::Projection::new(&scene, 128);
        for _ in 0..16 {
            for view in [[0u32, 3], [2, 2], [5, 1], [3, 4]] {
                let basis = ViewBasis::of_view(view.into(), 8);
                pr.look(&basis, v.frame.centre, v.frame.half_m(&basis));
            }
        }
        let t6 = cpu();
        println!("  64 looks {:?}", t6 - t5);
        save(&v.colour, 0, 0, &format!("{name}_views"));
        save(&v.colour, 2, 0, &format!("{name}_views_mip2"));
        save(&v.colour, 0, 1, &format!("{name}_views_rgb"));
        save(&v.surface, 0, 1, &format!("{name}_views_surface"));
        save(&v.surface, 0, 2, &format!("{name}_views_translucency"));
        if let Some(c) = c {
            println!(
                "  profile {:?} cover {} colour {:?} cone {}",
                c.profile,
                c.cover,
                c.mean_colour,
                c.profile.is_conical()
            );
            save(&c.colour, 0, 0, &format!("{name}_cylinder"));
            save(&c.colour, 0, 1, &format!("{name}_cylinder_rgb"));
            save(&c.colour, 2, 0, &format!("{name}_cylinder_mip2"));
        }
    }
}
