// The light on a tree: Bevy's own, or under `TreeLighting::SunOnly` the part of it that comes from suns and the ambient
// light. A processor that draws runs every branch of a shader, so that it pays for all kinds of lights where there are none.

#define_import_path bevy_windwood::light

#import bevy_pbr::pbr_types::PbrInput

#ifdef WINDWOOD_SUN_ONLY
#import bevy_pbr::ambient::ambient_light
#import bevy_pbr::lighting
#import bevy_pbr::mesh_view_bindings::{lights, view}
#import bevy_pbr::pbr_functions::{calculate_diffuse_color, calculate_F0, calculate_F0_dielectric}

#ifdef WINDWOOD_SHADOWS
#import bevy_pbr::mesh_types::MESH_FLAGS_SHADOW_RECEIVER_BIT
#import bevy_pbr::mesh_view_types::DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT
#ifdef PCSS_SAMPLERS_AVAILABLE
#import bevy_pbr::shadows::fetch_directional_shadow
#else
#import bevy_pbr::shadow_sampling::sample_shadow_map
#import bevy_pbr::shadows::world_to_directional_light_local
#endif
#endif

fn seen(in: PbrInput) -> lighting::LightingInput {
    let surface = in.material;
    let n_dot_v = max(dot(in.N, in.V), 0.0001);
    var input: lighting::LightingInput;
    input.layers[lighting::LAYER_BASE].NdotV = n_dot_v;
    input.layers[lighting::LAYER_BASE].N = in.N;
    input.layers[lighting::LAYER_BASE].R = reflect(-in.V, in.N);
    input.layers[lighting::LAYER_BASE].perceptual_roughness = surface.perceptual_roughness;
    input.layers[lighting::LAYER_BASE].roughness = lighting::perceptualRoughnessToRoughness(surface.perceptual_roughness);
    input.P = in.world_position.xyz;
    input.V = in.V;
    input.diffuse_color = calculate_diffuse_color(surface.base_color.rgb, surface.metallic, 0.0, surface.diffuse_transmission);
    input.metallic = surface.metallic;
    input.F0_dielectric = calculate_F0_dielectric(surface.reflectance);
    input.F0_metallic = surface.base_color.rgb;
    input.F_ab = lighting::F_AB(surface.perceptual_roughness, n_dot_v);
    return input;
}

// What shines through from behind: a second diffuse lobe of roughness 1 about -N, as Bevy has it, whose highlights are black.
fn transmitted(light_id: u32, in: PbrInput) -> vec3<f32> {
    let light = &lights.directional_lights[light_id];
    var lobe: lighting::LightingInput;
    lobe.layers[lighting::LAYER_BASE].NdotV = 1.0;
    lobe.layers[lighting::LAYER_BASE].roughness = 1.0;
    var derived = lighting::derive_lighting_input(-in.N, -in.V, (*light).direction_to_light.xyz);
    return (*light).color.rgb * (lighting::Fd_Burley(&lobe, &derived) * derived.NdotL);
}

#ifdef WINDWOOD_SHADOWS
#ifdef PCSS_SAMPLERS_AVAILABLE
fn shadow(light_id: u32, in: PbrInput, normal: vec3<f32>, view_z: f32) -> f32 {
    return fetch_directional_shadow(light_id, in.world_position, normal, view_z, in.frag_coord.xy);
}
#else
// Share of the sun in one cascade: `sample_directional_cascade` of Bevy's `shadows.wgsl`, without soft shadows, for which
// there are no samplers here.
fn share_in(light_id: u32, cascade_id: u32, in: PbrInput, normal: vec3<f32>) -> f32 {
    let light = &lights.directional_lights[light_id];
    let cascade = &(*light).cascades[cascade_id];
    let offset = (*light).shadow_normal_bias * (*cascade).texel_size * normal
        + (*light).shadow_depth_bias * (*light).direction_to_light.xyz;
    let place = world_to_directional_light_local(light_id, cascade_id, in.world_position + vec4(offset, 0.0));
    if place.w == 0.0 {
        return 1.0;
    }
    let layer = i32((*light).depth_texture_base_index + cascade_id);
    return sample_shadow_map(place.xy, place.z, layer, in.frag_coord.xy, (*cascade).texel_size);
}

// Share of the sun that arrives: in the cascade of this depth, and where it overlaps with the next in a mixture of both.
fn shadow(light_id: u32, in: PbrInput, normal: vec3<f32>, view_z: f32) -> f32 {
    let light = &lights.directional_lights[light_id];
    let count = (*light).num_cascades;
    var cascade = 0u;
    for (var i = 0u; i < count; i += 1u) {
        cascade += u32(-view_z >= (*light).cascades[i].far_bound);
    }
    if cascade >= count {
        return 1.0;
    }
    let far = (*light).cascades[cascade].far_bound;
    let overlap = (*light).cascades_overlap_proportion * far;
    var next = saturate((-view_z - far) / max(overlap, 1e-6) + 1.0);
    if cascade + 1u == count {
        next = 0.0;
    }
    var weight = 1.0 - next;
    var share = 0.0;
    // Its end is its test, so that where no pixel is in an overlap nothing is sampled twice.
    loop {
        share += weight * share_in(light_id, cascade, in, normal);
        weight = next;
        next = 0.0;
        continuing {
            cascade += 1u;
            break if weight == 0.0;
        }
    }
    return share;
}
#endif
#endif

fn sun_light(light_id: u32, in: PbrInput, input: ptr<function, lighting::LightingInput>, through: vec3<f32>, view_z: f32) -> vec3<f32> {
    let light = lighting::directional_light(light_id, input, true) + through * transmitted(light_id, in);
#ifdef WINDWOOD_SHADOWS
    let receives = (in.flags & MESH_FLAGS_SHADOW_RECEIVER_BIT) != 0u;
    if receives && (lights.directional_lights[light_id].flags & DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u {
        // Leaves are thin: a sun that does not light this side lights the other, and one shadow is enough for both.
        let faces = dot(in.N, lights.directional_lights[light_id].direction_to_light) > 0.0;
        return light * shadow(light_id, in, select(-in.world_normal, in.world_normal, faces), view_z);
    }
#endif
    return light;
}

fn lit(in: PbrInput) -> vec4<f32> {
    var front = seen(in);
    let colour = in.material.base_color.rgb;
    let through = colour * ((1.0 - in.material.metallic) * in.material.diffuse_transmission);
    let to_view = vec4(view.view_from_world[0].z, view.view_from_world[1].z, view.view_from_world[2].z, view.view_from_world[3].z);
    let view_z = dot(to_view, in.world_position);
    var sum = vec3(0.0);
    if lights.n_directional_lights > 0u {
        // A loop whose test is at its beginning is run once more than need be where every branch is run.
        var i = 0u;
        loop {
            sum += sun_light(i, in, &front, through, view_z);
            continuing {
                i += 1u;
                break if i >= lights.n_directional_lights;
            }
        }
    }
    let n_dot_v = front.layers[lighting::LAYER_BASE].NdotV;
    let f0 = calculate_F0(colour, in.material.metallic, in.material.reflectance);
    sum += ambient_light(in.world_position, in.N, in.V, n_dot_v, front.diffuse_color, f0, in.material.perceptual_roughness, in.diffuse_occlusion);
    sum += ambient_light(in.world_position, -in.N, -in.V, 1.0, through, vec3(0.0), 1.0, vec3(1.0));
    return vec4(view.exposure * sum, in.material.base_color.a);
}
#else
#import bevy_pbr::pbr_functions::apply_pbr_lighting

fn lit(in: PbrInput) -> vec4<f32> {
    return apply_pbr_lighting(in);
}
#endif
