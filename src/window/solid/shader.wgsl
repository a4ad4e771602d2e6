// Solid bodies: one directional light fixed to the eye, so that turning never leaves a side in the dark.
struct Scene {
    clip: mat4x4<f32>,
    light: vec4<f32>,
};

@group(0) @binding(0) var<uniform> scene: Scene;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) colour: vec4<f32>,
};

@vertex
fn body(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) colour: vec4<f32>,
) -> Corner {
    return Corner(scene.clip * vec4<f32>(position, 1.0), normal, colour);
}

// Colours are in gamma space throughout, as egui's are.
@fragment
fn lit(corner: Corner) -> @location(0) vec4<f32> {
    let facing = max(dot(normalize(corner.normal), scene.light.xyz), 0.0);
    let shade = scene.light.w + (1.0 - scene.light.w) * facing;
    return vec4<f32>(corner.colour.rgb * shade, corner.colour.a);
}

// The finished picture laid into egui's pass: one triangle over the viewport, texel to pixel.
@group(0) @binding(0) var picture: texture_2d<f32>;

struct Place {
    @builtin(position) position: vec4<f32>,
    @location(0) at: vec2<f32>,
};

@vertex
fn cover(@builtin(vertex_index) k: u32) -> Place {
    let at = vec2<f32>(f32((k << 1u) & 2u), f32(k & 2u));
    return Place(vec4<f32>(at.x * 2.0 - 1.0, 1.0 - at.y * 2.0, 0.0, 1.0), at);
}

fn texel(at: vec2<f32>) -> vec4<f32> {
    let size = vec2<i32>(textureDimensions(picture));
    let p = clamp(vec2<i32>(floor(at * vec2<f32>(size))), vec2<i32>(0), size - 1);
    return textureLoad(picture, p, 0);
}

@fragment
fn lay_gamma(place: Place) -> @location(0) vec4<f32> {
    return texel(place.at);
}

fn linear_of(c: vec3<f32>) -> vec3<f32> {
    let low = c / 12.92;
    let high = pow((c + 0.055) / 1.055, vec3<f32>(2.4));
    return select(high, low, c <= vec3<f32>(0.04045));
}

@fragment
fn lay_linear(place: Place) -> @location(0) vec4<f32> {
    let c = texel(place.at);
    return vec4<f32>(linear_of(c.rgb), c.a);
}
