// Water that hangs over air, drawn over the picture of the water below it: a sheet between two height maps. Light is mirrored at
// the face that the eye sees, by Fresnel's equations, and bent through the sheet to what lies behind.
#include "frame.glsl"
#include "pool.glsl"
#include "height_map.glsl"
#ifdef CLIP_GLASS
#include "glass.glsl"
#endif

layout(std140, binding = 1) uniform Params {
  ivec4 ends[2];        // of the bodies of each shape
  ivec4 quads;          // the first texel of the mesh and how many quads, along x and z
  ivec4 steps;          // texels from one quad to the next; –
};
layout(binding = 1) uniform sampler2D overhang_top;       // as height_surface
layout(binding = 2) uniform sampler2D overhang_underside;

// The sheet over a place: the heights of its faces (m), their slopes along x and z, and how much of it there is: below ½ none.
struct Sheet {
  float top, underside;
  vec2 top_slope, underside_slope;
  float share;
};

float share_at(vec2 place) {
  return textureLod(overhang_top, place, 0.0).y;
}

// Its faces meet where its share is ½, on an edge that is round.
Sheet sheet_at(vec2 xz) {
  vec2 place = height_place_of(xz), texel = 1.0 / vec2(textureSize(overhang_top, 0));
  vec4 t = textureLod(overhang_top, place, 0.0), u = textureLod(overhang_underside, place, 0.0);
  vec2 rise = vec2(share_at(place + vec2(texel.x, 0.0)) - share_at(place - vec2(texel.x, 0.0)),
                   share_at(place + vec2(0.0, texel.y)) - share_at(place - vec2(0.0, texel.y)));
  float thin = sqrt(clamp(2.0 * t.y - 1.0, 0.0, 1.0)), half_way = 0.5 * (t.x + u.x), half_thick = max(0.5 * (t.x - u.x), 0.0);
  vec2 thinning = rise / (2.0 * height_range.z * max(thin, 0.1));
  vec2 slope = 0.5 * (t.zw + u.zw), widening = 0.5 * (t.zw - u.zw) * thin + half_thick * thinning;
  return Sheet(half_way + half_thick * thin, half_way - half_thick * thin, slope + widening, slope - widening, t.y);
}

#ifdef VERTEX_STAGE
const vec2 CORNERS[6] = vec2[6](vec2(0, 0), vec2(0, 1), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(1, 0));
out vec3 at;
flat out vec3 outward;  // upwards: the top; downwards: the underside; of a wall of the container

vec2 place_of(ivec2 texel) {
  return ((vec2(texel) + 0.5) / vec2(textureSize(overhang_top, 0)) - height_place.zw) / height_place.xy;
}

ivec2 corner_of(ivec2 quad) {
  return min(quads.xy + quad * steps.x, textureSize(overhang_top, 0) - 1);
}

// Does a quad have any of the sheet?
bool in_sheet(ivec2 quad) {
  float most = 0.0;
  for (int k = 0; k < 4; ++k) most = max(most, texelFetch(overhang_top, corner_of(quad + ivec2(k & 1, k >> 1)), 0).y);
  return most >= 0.5;
}

void main() {
  int quad = gl_VertexID / 6, cells = quads.z * quads.w, side = quad - 2 * cells;
  vec2 corner = CORNERS[gl_VertexID % 6];
  ivec2 last = textureSize(overhang_top, 0) - 1, texel;
  float up = corner.y;
  bool shown;
  if (side < 0) {
    ivec2 cell = ivec2(quad % cells % quads.z, quad % cells / quads.z);
    up = quad < cells ? 1.0 : 0.0;
    outward = vec3(0.0, 2.0 * up - 1.0, 0.0);
    texel = corner_of(cell + ivec2(corner));
    shown = in_sheet(cell);
  } else { // along the two walls of x, then those of z
    bool of_x = side < 2 * quads.w;
    int along = of_x ? quads.w : quads.z;
    bool far = (of_x ? side : side - 2 * quads.w) >= along;
    int piece = (of_x ? side : side - 2 * quads.w) % along + int(corner.x);
    ivec2 end = corner_of(quads.zw);
    texel = corner_of(of_x ? ivec2(0, piece) : ivec2(piece, 0));
    texel = of_x ? ivec2(far ? end.x : quads.x, texel.y) : ivec2(texel.x, far ? end.y : quads.y);
    outward = of_x ? vec3(far ? 1.0 : -1.0, 0.0, 0.0) : vec3(0.0, 0.0, far ? 1.0 : -1.0);
    shown = texelFetch(overhang_top, texel, 0).y >= 0.5 &&
            (of_x ? (far ? end.x == last.x : quads.x == 0) : (far ? end.y == last.y : quads.y == 0));
#ifndef CLIP_BOX
    shown = false;
#endif
  }
  vec2 xz = place_of(texel);
#ifdef CLIP_BOX
  // At a wall the faces are behind the side of the water below, and that is behind the sheet's own: what is seen through there
  // goes on in the water that the sheet grows from, not the other way round.
  float inset = (outward.y == 0.0 ? 1e-4 : 3e-4) * container_max.w;
  xz = clamp(xz, container_min.xz + inset, container_max.xz - inset);
#endif
  Sheet sheet = sheet_at(xz);
  at = vec3(xz.x, mix(sheet.underside, sheet.top, up), xz.y);
  gl_Position = shown ? project(to_view(at)) : vec4(2.0, 2.0, 0.0, 1.0);
}
#endif

#ifdef FRAGMENT_STAGE
#define body_end int[6](ends[0].x, ends[0].y, ends[0].z, ends[0].w, ends[1].x, ends[1].y)
layout(binding = 0) uniform sampler2D behind;     // the picture without the sheet
layout(binding = 8) uniform sampler2D background; // linear light, depth
#include "scene.glsl"
#include "scene_light.glsl"
#include "container.glsl"
#include "fresnel.glsl"
#include "pool_water.glsl"
#include "water_colours.glsl"
in vec3 at;
flat in vec3 outward;
layout(location = 0) out vec4 result;

// How far a point is within the sheet, m: negative outside.
float depth_in(Sheet sheet, float y) {
  return sheet.share < 0.5 ? -height_range.z : min(sheet.top - y, y - sheet.underside);
}

// Metres to where a ray in the sheet leaves it. Marching, then the secant method.
float way_out(vec3 p, vec3 way, float thickness) {
  const int STEPS = 16;
  float step_on = max(0.3 * thickness, height_range.z), before = 0.0, f = 1e-5;
  float end = max(room_from(p, way).y, 0.0);
  for (int i = 1; i <= STEPS; ++i) {
    float t = min(step_on * float(i), end);
    vec3 there = p + way * t;
    float g = depth_in(sheet_at(there.xz), there.y);
    if (g < 0.0) {
      for (int k = 0; k < 3; ++k) {
        float middle = mix(before, t, f / (f - g));
        there = p + way * middle;
        float h = depth_in(sheet_at(there.xz), there.y);
        if (h < 0.0) { t = middle; g = h; } else { before = middle; f = max(h, 1e-5); }
      }
      return mix(before, t, f / (f - g));
    }
    if (t >= end) return end;
    before = t;
    f = max(g, 1e-5);
  }
  return before;
}

vec3 top_normal(Sheet sheet) {
  return normalize(vec3(-sheet.top_slope.x, 1.0, -sheet.top_slope.y));
}

vec3 underside_normal(Sheet sheet) {
  return normalize(vec3(sheet.underside_slope.x, -1.0, sheet.underside_slope.y));
}

// Outward unit normal where a ray leaves the sheet.
vec3 normal_out(vec3 p) {
#ifdef CLIP_BOX
  vec3 within = min(p - container_min.xyz, container_max.xyz - p);
  if (min(within.x, within.z) < 1e-3 * height_range.z) return wall_normal(p);
#endif
  Sheet sheet = sheet_at(p.xz);
  return sheet.top - p.y < p.y - sheet.underside ? top_normal(sheet) : underside_normal(sheet);
}

// Metres to where a ray in the air comes down to the water below; FAR: nowhere.
float water_ahead(vec3 p, vec3 way) {
  if (way.y >= 0.0 || height_range.y < height_range.x) return FAR;
  float t = max(p.y - height_range.y, 0.0) / -way.y;
  for (int k = 0; k < 3; ++k) {
    vec2 xz = p.xz + way.xz * t;
    if (over_water(xz)) t = max(p.y - water_surface(xz).x, 0.0) / -way.y;
  }
  return over_water(p.xz + way.xz * t) ? t : FAR;
}

// What a ray in the air sees: the water below as the picture has it where the ray meets it, and the scene.
vec3 light_around(vec3 p, vec3 way, float path) {
  Meeting meeting = meet_scene(p, way);
  float water = water_ahead(p, way);
  if (water >= meeting.t) {
    return past_edges(p, way, meeting.t, path, light_from(p, way, meeting, pixel_at(path + min(meeting.t, 1e4))));
  }
  vec3 v = to_view(p + way * water);
  vec2 there = v.xy / (max(-v.z, eye.w) * lens.xy);
  vec2 pixel = clamp((there * 0.5 + 0.5) * lens.zw, vec2(0.0), lens.zw - 1.0);
  return texelFetch(behind, ivec2(pixel), 0).rgb;
}

// What a ray in the sheet sees, from where it begins to where it comes out or goes on in the water that the sheet grows from.
// `inner`: the share that is mirrored where it comes out.
vec3 light_in_sheet(vec3 way, Sheet sheet, float path, out float inner) {
  const int LEGS = 3;
  vec3 p = at, out_of_it = vec3(0.0);
  float metres = 0.0, thickness = sheet.top - sheet.underside;
  bool on_in_water = false;
  inner = 0.0;
  for (int i = 0; i < LEGS && out_of_it == vec3(0.0) && !on_in_water; ++i) {
    way = i > 0 ? reflect(way, normal_out(p)) : way; // mirrored altogether
    p += way * (1e-4 * container_max.w);
    float t = way_out(p, way, thickness);
    metres += t;
    p += way * t;
    on_in_water = over_water(p.xz) && p.y < water_surface(p.xz).x;
    vec3 normal = normal_out(p);
    normal = dot(normal, way) > 0.0 ? normal : -normal;
    out_of_it = refract(way, -normal, optics.x);
    inner = on_in_water || out_of_it == vec3(0.0) ? 0.0 : fresnel(dot(way, normal), 1.0 / optics.x);
  }
  out_of_it = out_of_it == vec3(0.0) ? way : out_of_it;

  // A software rasteriser runs both sides of a branch, but no loop that does not begin.
  vec3 light = vec3(0.0);
  for (int once = 0; once < int(on_in_water); ++once) {
    float more;
    light = light_in_water(p, way, path + metres, more);
    light = tinted(through_water(light, more, 1.0, lit_along(p, way, more)), p.xz, 0, more);
  }
  for (int once = int(on_in_water); once < 1; ++once) light = light_around(p, out_of_it, path + metres);
  return tinted(through_water(light, metres, 1.0, sun_past_solids(at)), at.xz, 1, metres);
}

void main() {
  float depth = 1.0 / gl_FragCoord.w;
  if (depth < eye.w) discard;
#ifdef CLIP_GLASS
  Glass glass = glass_of_container();
  if (distance(at.xz, glass.centre) > glass.radius * INSIDE) discard;
#endif
  Sheet sheet = sheet_at(at.xz);
  if (sheet.share < 0.5) discard;
  vec3 way = normalize(at - eye.xyz);
  vec3 normal = facing_eye(outward.y == 0.0 ? outward : outward.y > 0.0 ? top_normal(sheet) : underside_normal(sheet), way);
  float path = distance(at, eye.xyz), inner, outer = fresnel(-dot(normal, way), optics.x);
  vec3 through = light_in_sheet(refract(way, normal, 1.0 / optics.x), sheet, path, inner), mirrored_way = reflect(way, normal);
  vec3 mirrored = light_around(at, mirrored_way, path) + sun_mirrored(at, mirrored_way);
  // What is mirrored inside comes out on this side, more or less like what is mirrored at once, or goes on, and so on.
  float let_through = (1.0 - outer) * (1.0 - inner) / max(1.0 - outer * inner, 1e-6);
  result = vec4(mix(mirrored, through, let_through), 1.0);
}
#endif
