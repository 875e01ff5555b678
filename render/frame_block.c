// Camera, sun and environment: the Frame block that every shader reads, and the choices made when shaders are compiled.
#include "render/picture.h"

#include <cglm/cglm.h>
#include <float.h>
#include <stdio.h>
#include <string.h>

static void set4(float out[4], const float xyz[3], float w) {
  out[0] = xyz[0];
  out[1] = xyz[1];
  out[2] = xyz[2];
  out[3] = w;
}

// ---- Camera ----------------------------------------------------------------------------------------------------------

// Looking from eye at target. Up is y, or, where the gaze is nearly vertical, whatever horizontal axis is farthest
// from it.
static void write_camera(RenderFrameBlock *block, const RenderPicture *picture, const RenderView *view) {
  vec3 gaze = {view->target[0] - view->eye[0], view->target[1] - view->eye[1], view->target[2] - view->eye[2]};
  glm_vec3_normalize(gaze);
  vec3 up = {0, 1, 0};
  if (fabsf(gaze[1]) > 0.9999f) glm_vec3_copy((vec3){0, 0, -1}, up);
  mat4 look;
  glm_look(GLM_VEC3_ZERO, gaze, up, look); // rotation only: shaders subtract the eye first, which keeps precision
  memcpy(block->world_to_view, look, sizeof block->world_to_view);
  set4(block->eye, view->eye, RENDER_NEAR);

  const float tan_y = tanf(glm_rad(view->vertical_fov) / 2);
  const float tan_x = tan_y * (float)picture->width / (float)picture->height;
  const float lens[4] = {tan_x, tan_y, (float)picture->width, (float)picture->height};
  memcpy(block->lens, lens, sizeof lens);
}

// ---- The box around everything ---------------------------------------------------------------------------------------

typedef struct Box {
  vec3 min, max;
} Box;

static void box_add(Box *box, const float min[3], const float max[3]) {
  for (int k = 0; k < 3; ++k) {
    if (!(min[k] <= max[k]) || !(fabsf(min[k]) < RENDER_FARTHEST) || !(fabsf(max[k]) < RENDER_FARTHEST)) return;
  }
  glm_vec3_minv(box->min, (vec3){min[0], min[1], min[2]}, box->min);
  glm_vec3_maxv(box->max, (vec3){max[0], max[1], max[2]}, box->max);
}

// Container (or, without one, the water) and obstacles. Values from outside may be absurd; then they are left out.
static Box scene_box(const RenderPicture *picture) {
  const SimFrame *frame = picture->frame;
  const float margin = 2 * frame->particle_radius;
  Box box = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
  if (frame->has_container) box_add(&box, frame->container.min, frame->container.max);
  if (box.min[0] > box.max[0]) box_add(&box, picture->particles.bounds_min, picture->particles.bounds_max);
  box_add(&box, picture->obstacles.bounds_min, picture->obstacles.bounds_max);
  if (box.min[0] > box.max[0]) box_add(&box, (vec3){0, 0, 0}, (vec3){1, 1, 1});
  for (int k = 0; k < 3 && margin > 0 && margin < 1e3f; ++k) {
    box.min[k] -= margin;
    box.max[k] += margin;
  }
  return box;
}

// ---- Sun -------------------------------------------------------------------------------------------------------------

// Fit the map's axis `row` to the box's extent along the unit vector `axis`: place = dot(p, row.xyz) + row.w.
static float fit_axis(float row[4], const vec3 axis, const Box *box) {
  float low = 0, high = 0;
  for (int k = 0; k < 3; ++k) {
    low += axis[k] * (axis[k] > 0 ? box->min[k] : box->max[k]);
    high += axis[k] * (axis[k] > 0 ? box->max[k] : box->min[k]);
  }
  const float extent = fmaxf(1.02f * (high - low), 1e-4f);
  const float start = 0.5f * (low + high) - 0.5f * extent;
  for (int k = 0; k < 3; ++k) row[k] = axis[k] / extent;
  row[3] = -start / extent;
  return extent;
}

static void write_sun(RenderFrameBlock *block, const RenderSettings *settings, const Box *box) {
  vec3 sun = {settings->sun_direction[0], settings->sun_direction[1], settings->sun_direction[2]};
  glm_vec3_scale(sun, 1 / fmaxf(fmaxf(fabsf(sun[0]), fabsf(sun[1])), fabsf(sun[2])), sun); // squares stay in range
  glm_vec3_normalize(sun);
  set4(block->sun_direction, sun, settings->sun ? 1 : 0);
  const float dark[3] = {0, 0, 0};
  set4(block->sun_colour, settings->sun ? settings->sun_colour : dark, 0);

  // Right-handed axes across the sunlight, u level with the floor.
  vec3 u, v;
  glm_vec3_cross(fabsf(sun[1]) > 0.9999f ? (vec3){0, 0, 1} : (vec3){0, 1, 0}, sun, u);
  glm_vec3_normalize(u);
  glm_vec3_cross(sun, u, v);
  block->sun_map[0] = fit_axis(block->sun_u, u, box);
  block->sun_map[1] = fit_axis(block->sun_v, v, box);
  block->sun_map[2] = 1 - 1 / settings->refractive_index;
}

// The floor lies where the scene says, else under the container, else under the particles' spheres.
static float floor_level(const RenderPicture *picture, const Box *box) {
  if (!isnan(picture->settings->floor_level)) return picture->settings->floor_level;
  const float lowest = picture->frame->container.min[1];
  const bool sensible = picture->frame->has_container && fabsf(lowest) < RENDER_FARTHEST;
  return sensible ? lowest : box->min[1];
}

// ---- Everything ------------------------------------------------------------------------------------------------------

static void write_environment(RenderFrameBlock *block, const RenderPicture *picture, const Box *box) {
  const RenderSettings *settings = picture->settings;
  const SimContainer *container = &picture->frame->container;
  const float ratio = (settings->refractive_index - 1) / (settings->refractive_index + 1);
  const float across = glm_vec3_distance((float *)(uintptr_t)box->min, (float *)(uintptr_t)box->max);
  set4(block->absorption, settings->absorption, ratio * ratio);
  set4(block->scattering, settings->scattering, 0);
  set4(block->reflectance, settings->reflectance, 0);
  set4(block->sky_zenith, settings->sky_zenith, 0);
  set4(block->sky_horizon, settings->sky_horizon, 0);
  set4(block->floor_colour[0], settings->floor_colour[0], 0);
  set4(block->floor_colour[1], settings->floor_colour[1], 0);
  const float plane[4] = {floor_level(picture, box), settings->tile_size, 24 * across, 0};
  memcpy(block->floor_plane, plane, sizeof plane);
  const bool visible =
      settings->container_visible && picture->frame->has_container && (unsigned)container->shape <= SIM_CONTAINER_GLASS;
  set4(block->container_min, container->min, visible ? 1 : 0);
  set4(block->container_max, container->max, across);
}

// Level water's light is moved to the middle of its level, so that small waves do not change it.
static float level_shift(const RenderCartoon *cartoon, const RenderFrameBlock *block) {
  const float level = (float)cartoon->levels * fmaxf(block->sun_direction[1], 0);
  return cartoon->steady ? 0.5f - (level - floorf(level)) : 0;
}

static void write_drawing(RenderFrameBlock *block, const RenderCartoon *cartoon) {
  const RenderPalette *palette = &cartoon->palette;
  const float levels[4] = {(float)cartoon->levels, cartoon->bright_levels, level_shift(cartoon, block),
                           cartoon->outline};
  const float regions[4] = {cartoon->bright_threshold, cartoon->dark_threshold, cartoon->bright_factor,
                            cartoon->dark_factor};
  memcpy(block->drawn_levels, levels, sizeof levels);
  memcpy(block->drawn_regions, regions, sizeof regions);
  set4(block->drawn_ink, palette->ink, cosf(glm_rad(cartoon->crease_angle)));
  set4(block->drawn_shade, palette->shade, 0);
  for (int i = 0; i < 3; ++i) set4(block->drawn_sky[i], palette->sky[i], 0);
  for (int i = 0; i < 2; ++i) set4(block->drawn_floor[i], palette->floor[i], 0);
}

static void write_defines(RenderPicture *picture) {
  const RenderSettings *s = picture->settings;
  static const char *const skies[] = {"SKY_CLEAR", "SKY_GRADIENT"};
  static const char *const floors[] = {"FLOOR_TILES", "FLOOR_CHECKER", "FLOOR_NONE"};
  const bool shadow = s->sun && s->shadow;
  const bool water = picture->particles.count > 0;
  const bool solids = picture->obstacles.count > 0;
  snprintf(picture->defines, sizeof picture->defines, "#define %s 1\n#define %s 1\n%s%s%s", skies[s->sky],
           floors[s->floor], picture->drawn ? "#define DRAWN 1\n" : "",
           shadow && water ? "#define WATER_SHADOW 1\n" : "", shadow && solids ? "#define SOLID_SHADOW 1\n" : "");
}

bool render_frame_block_write(RenderPicture *picture, const RenderView *view, RenderError *error) {
  RenderFrameBlock *block = &picture->block;
  *block = (RenderFrameBlock){0};
  const Box box = scene_box(picture);
  write_camera(block, picture, view);
  write_sun(block, picture->settings, &box);
  write_environment(block, picture, &box);
  write_drawing(block, &picture->settings->cartoon);
  write_defines(picture);
  return gpu_buffer_write(&picture->uniforms, "frame block", block, sizeof *block, error);
}
