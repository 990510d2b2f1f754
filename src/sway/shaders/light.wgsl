// The light on a tree: Bevy's own, or under `TreeLighting::SunOnly` the part of it that comes from suns and the ambient
// light. A processor that draws runs every branch of a shader, so that it pays for all kinds of lights where there are none.

#define_import_path bevy_windwood::light

#import bevy_pbr::pbr_types::PbrInput

#ifdef WINDWOOD_SUN_ONLY
#import bevy_pbr::ambient::ambient_light
#import bevy_pbr::lighting
#import bevy_pbr::mesh_types::MESH_FLAGS_SHADOW_RECEIVER_BIT
#import bevy_pbr::mesh_view_bindings::{lights, view}
#import bevy_pbr::mesh_view_types::DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT
#import bevy_pbr::pbr_functions::{calculate_diffuse_color, calculate_F0, calculate_F0_dielectric}
#import bevy_pbr::shadows::fetch_directional_shadow

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

// What shines through from behind.
fn transmitted(in: PbrInput) -> lighting::LightingInput {
    var input: lighting::LightingInput;
    input.layers[lighting::LAYER_BASE].NdotV = 1.0;
    input.layers[lighting::LAYER_BASE].N = -in.N;
    input.layers[lighting::LAYER_BASE].R = vec3(0.0);
    input.layers[lighting::LAYER_BASE].perceptual_roughness = 1.0;
    input.layers[lighting::LAYER_BASE].roughness = 1.0;
    input.P = in.world_position.xyz;
    input.V = -in.V;
    input.diffuse_color = in.material.base_color.rgb * ((1.0 - in.material.metallic) * in.material.diffuse_transmission);
    input.metallic = 0.0;
    input.F0_dielectric = vec3(0.0);
    input.F0_metallic = vec3(0.0);
    input.F_ab = vec2(0.1);
    return input;
}

fn lit(in: PbrInput) -> vec4<f32> {
    var front = seen(in);
    var back = transmitted(in);
    let to_view = vec4(view.view_from_world[0].z, view.view_from_world[1].z, view.view_from_world[2].z, view.view_from_world[3].z);
    let view_z = dot(to_view, in.world_position);
    let receives = (in.flags & MESH_FLAGS_SHADOW_RECEIVER_BIT) != 0u;
    var sum = vec3(0.0);
    for (var i = 0u; i < lights.n_directional_lights; i += 1u) {
        // Leaves are thin: a sun that does not light this side lights the other, and one shadow is enough for both.
        let faces = dot(in.N, lights.directional_lights[i].direction_to_light) > 0.0;
        var share = 1.0;
        if receives && (lights.directional_lights[i].flags & DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u {
            let normal = select(-in.world_normal, in.world_normal, faces);
            share = fetch_directional_shadow(i, in.world_position, normal, view_z, in.frag_coord.xy);
        }
        sum += lighting::directional_light(i, &front, true) * share;
        if in.material.diffuse_transmission > 0.0 {
            sum += lighting::directional_light(i, &back, true) * share;
        }
    }
    let n_dot_v = front.layers[lighting::LAYER_BASE].NdotV;
    let f0 = calculate_F0(in.material.base_color.rgb, in.material.metallic, in.material.reflectance);
    sum += ambient_light(in.world_position, in.N, in.V, n_dot_v, front.diffuse_color, f0, in.material.perceptual_roughness, in.diffuse_occlusion);
    sum += ambient_light(in.world_position, -in.N, -in.V, 1.0, back.diffuse_color, vec3(0.0), 1.0, vec3(1.0));
    return vec4(view.exposure * sum, in.material.base_color.a);
}
#else
#import bevy_pbr::pbr_functions::apply_pbr_lighting

fn lit(in: PbrInput) -> vec4<f32> {
    return apply_pbr_lighting(in);
}
#endif
