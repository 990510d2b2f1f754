#![allow(missing_docs)]
use bevy::{
    asset::RenderAssetUsages, prelude::*, image::*, mesh::*, render::{RenderPlugin, render_resource::*, renderer::RenderDevice},
    window::ExitCondition, winit::WinitPlugin, camera::RenderTarget, render::view::screenshot::*,
    core_pipeline::tonemapping::Tonemapping, light::CascadeShadowConfigBuilder,
};
use bevy_windwood::tree::{species::Species, skeleton, mesh, leaf_mesh, bark::bark_textures, leaf_texture::leaf_texture, texture::TextureData};

fn image(t: &TextureData, repeat: bool) -> Image {
    let fmt = if t.srgb { TextureFormat::Rgba8UnormSrgb } else { TextureFormat::Rgba8Unorm };
    let mut i = Image::new(Extent3d{width:t.width,height:t.height,depth_or_array_layers:1}, TextureDimension::D2, t.mips[0].clone(), fmt, RenderAssetUsages::default());
    i.data = Some(t.mips.concat());
    i.texture_descriptor.mip_level_count = t.mips.len() as u32;
    let mode = if repeat { ImageAddressMode::Repeat } else { ImageAddressMode::ClampToEdge };
    i.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor{address_mode_u:mode,address_mode_v:mode,mag_filter:ImageFilterMode::Linear,min_filter:ImageFilterMode::Linear,mipmap_filter:ImageFilterMode::Linear,anisotropy_clamp:8,..default()});
    i
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let name = args[1].clone();
    let seed: u64 = args[2].parse().unwrap();
    let out = args[3].clone();
    let views: Vec<String> = args[4..].to_vec();
    let species = Species::from_ron(&std::fs::read_to_string(format!("assets/species/{name}.species.ron")).unwrap()).unwrap();
    let t0 = std::time::Instant::now();
    let sk = skeleton::grow(&species, seed);
    let w = mesh::wood(&species, &sk);
    let l = leaf_mesh::leaves(&species, &sk);
    let t1 = t0.elapsed();
    let bt = bark_textures(&species.wood.bark, 1);
    let t2 = t0.elapsed();
    let lt = leaf_texture(&species.foliage, 1);
    let t3 = t0.elapsed();
    let mut orders = [0; 6]; sk.beams.iter().for_each(|b| orders[b.order as usize] += 1);
    println!("{name} {seed}: beams {} {orders:?} clusters {} height {:.1} wood {} v {} t, leaves {} v {} t; total {} v {} t; grow+mesh {:?} bark {:?} leaf {:?}", sk.beams.len(), sk.clusters.len(), sk.height_m(), w.positions.len(), w.indices.len()/3, l.positions.len(), l.indices.len()/3, w.positions.len()+l.positions.len(), (w.indices.len()+l.indices.len())/3, t1, t2-t1, t3-t2);
    if views.iter().any(|v| v == "tex") {
        for (n, t) in [("bark", &bt.base_colour), ("barkn", &bt.normal), ("leaf", &lt)] {
            let mut px = t.mips[0].clone();
            if n == "leaf" { for p in px.chunks_mut(4) { if p[3] < 128 { p[0]=200;p[1]=210;p[2]=230; } p[3]=255; } }
            image::save_buffer(format!("{out}_{n}.png"), &px, t.width, t.height, image::ColorType::Rgba8).unwrap();
        }
    }
    let views: Vec<_> = views.into_iter().filter(|v| v != "tex").collect();
    if views.is_empty() { return; }
    let mut app = App::new();
    app.add_plugins(DefaultPlugins.set(WindowPlugin{primary_window:None,exit_condition:ExitCondition::DontExit,..default()}).set(RenderPlugin{synchronous_pipeline_compilation:true,..default()}).disable::<WinitPlugin>().disable::<bevy::log::LogPlugin>());
    app.insert_resource(ClearColor(Color::srgb(0.53,0.70,0.92)));
    app.insert_resource(GlobalAmbientLight{color:Color::srgb(0.75,0.85,1.0),brightness:900.0,..default()});
    app.finish(); app.cleanup();
    let world = app.world_mut();
    let bark = world.resource_mut::<Assets<Image>>().add(image(&bt.base_colour,true));
    let barkn = world.resource_mut::<Assets<Image>>().add(image(&bt.normal,true));
    let leaft = world.resource_mut::<Assets<Image>>().add(image(&lt,false));
    let shadow_size = 4096; world.insert_resource(bevy::light::DirectionalLightShadowMap{size:shadow_size});
    let shade = |light: f32, tint: f32, lo: f32| { let a = lo + (1.0-lo)*light; let k = 0.85+0.35*tint; [a*k*(0.92+0.2*tint), a*k, a*k*(1.05-0.25*tint), 1.0] };
    let mut wm = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
    let wc: Vec<[f32;4]> = w.sway.iter().map(|s| { let a = 0.5+0.5*s[3]; [a,a,a,1.0] }).collect();
    wm.insert_attribute(Mesh::ATTRIBUTE_POSITION, w.positions); wm.insert_attribute(Mesh::ATTRIBUTE_NORMAL, w.normals); wm.insert_attribute(Mesh::ATTRIBUTE_UV_0, w.uvs); wm.insert_attribute(Mesh::ATTRIBUTE_COLOR, wc); wm.insert_indices(Indices::U32(w.indices));
    wm.generate_tangents().unwrap();
    let mut lm = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
    let lc: Vec<[f32;4]> = l.sway.iter().zip(&l.axis).map(|(s,a)| shade(s[3], a[3], 0.25)).collect();
    lm.insert_attribute(Mesh::ATTRIBUTE_POSITION, l.positions); lm.insert_attribute(Mesh::ATTRIBUTE_NORMAL, l.normals); lm.insert_attribute(Mesh::ATTRIBUTE_UV_0, l.uvs); lm.insert_attribute(Mesh::ATTRIBUTE_COLOR, lc); lm.insert_indices(Indices::U32(l.indices));
    let wm = world.resource_mut::<Assets<Mesh>>().add(wm);
    let lm = world.resource_mut::<Assets<Mesh>>().add(lm);
    let wmat = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial{base_color_texture:Some(bark),normal_map_texture:Some(barkn),perceptual_roughness:0.95,reflectance:0.2,..default()});
    let lmat = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial{base_color_texture:Some(leaft),perceptual_roughness:0.7,reflectance:0.25,diffuse_transmission:0.35,alpha_mode:AlphaMode::Mask(0.5),double_sided:false,cull_mode:None,..default()});
    if std::env::var("NOLEAF").is_err() { world.spawn((Mesh3d(lm),MeshMaterial3d(lmat))); }
    world.spawn((Mesh3d(wm),MeshMaterial3d(wmat)));
    let g = world.resource_mut::<Assets<Mesh>>().add(Plane3d::new(Vec3::Y, Vec2::splat(400.0)).mesh().build());
    let gm = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial{base_color:Color::srgb(0.30,0.40,0.16),perceptual_roughness:1.0,reflectance:0.1,..default()});
    world.spawn((Mesh3d(g),MeshMaterial3d(gm)));
    world.spawn((DirectionalLight{illuminance:9000.0,shadow_maps_enabled:true,..default()}, CascadeShadowConfigBuilder{num_cascades:1,maximum_distance:70.0,..default()}.build(), Transform::from_xyz(-0.55,0.8,0.6).looking_at(Vec3::ZERO,Vec3::Y)));
    let h = sk.height_m();
    let target = world.resource_mut::<Assets<Image>>().add(Image::new_target_texture(720,720,TextureFormat::Rgba8UnormSrgb,None));
    let cam = world.spawn((Camera3d::default(),Msaa::Sample4,RenderTarget::Image(target.clone().into()),Tonemapping::Reinhard,Projection::Perspective(PerspectiveProjection{fov:0.6,..default()}),Transform::default())).id();
    for v in views {
        let (eye, at, fov) = match v.as_str() {
            "whole" => (vec3(2.0,1.7,33.0), vec3(0.0,h*0.48,0.0), 0.66),
            "far" => (vec3(12.0,6.0,90.0), vec3(0.0,h*0.45,0.0), 0.4),
            "side" => (vec3(33.0,1.7,-4.0), vec3(0.0,h*0.48,0.0), 0.66),
            "back" => (vec3(14.0,1.7,-26.0), vec3(0.0,h*0.48,0.0), 0.7),
            "crown" => (vec3(-3.0,h*0.55,15.0), vec3(-1.0,h*0.6,0.0), 0.6),
            "under" => (vec3(2.0,1.6,6.5), vec3(0.0,h*0.38,0.0), 1.0),
            "base" => (vec3(0.8,1.3,3.4), vec3(0.0,0.6,0.0), 0.75),
            "fork" => (vec3(0.6,2.0,6.0), vec3(0.0,5.0,0.0), 0.55),
            "bare" => (vec3(2.0,1.7,33.0), vec3(0.0,h*0.48,0.0), 0.66),
            "top" => (vec3(0.0,h*0.85,12.0), vec3(0.0,h*0.8,0.0), 0.6),
            _ => panic!(),
        };
        app.world_mut().entity_mut(cam).insert((Transform::from_translation(eye).looking_at(at,Vec3::Y), Projection::Perspective(PerspectiveProjection{fov,..default()})));
        let step = |app: &mut App| { app.update(); let _ = app.world().resource::<RenderDevice>().wgpu_device().poll(wgpu_types::PollType::Wait{submission_index:None,timeout:None}); };
        for _ in 0..4 { step(&mut app); }
        let path = format!("{out}_{v}.png"); let _ = std::fs::remove_file(&path);
        app.world_mut().spawn(Screenshot::image(target.clone())).observe(save_to_disk(path.clone()));
        for _ in 0..20 { step(&mut app); if std::fs::metadata(&path).is_ok() { break; } }
    }
}
