#include "app/scene.h"

#include <cjson/cJSON.h>

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/scene_parse.h"

// ---- Reading the file -----------------------------------------------------------------------------------------------

static bool too_large(const char *path, AppError *error) {
  return app_fail(error, APP_BAD_INPUT, "%s: larger than %d MiB, the most that a scene may have", path,
                  SCENE_MOST_BYTES / (1024 * 1024));
}

static FILE *open_file(const char *path, AppError *error) {
  struct stat status;
  if (stat(path, &status) == 0 && S_ISDIR(status.st_mode)) {
    app_fail(error, APP_BAD_INPUT, "%s: is a directory, not a scene file", path);
    return NULL;
  }
  FILE *file = fopen(path, "rb");
  if (!file) app_fail(error, APP_BAD_INPUT, "%s: %s", path, strerror(errno));
  return file;
}

/// Read all of the file, which need not tell its size, but never more than the limit. NULL and *error when that fails.
static char *read_file(const char *path, size_t *size, AppError *error) {
  FILE *file = open_file(path, error);
  if (!file) return NULL;
  char *data = NULL;
  size_t used = 0;
  for (size_t capacity = 64 * 1024;; capacity *= 2) {
    char *larger = realloc(data, capacity);
    if (!larger) {
      app_fail(error, APP_FAILED, "%s: out of memory", path);
      break;
    }
    data = larger;
    used += fread(data + used, 1, capacity - used, file);
    if (ferror(file)) {
      app_fail(error, APP_BAD_INPUT, "%s: %s", path, strerror(errno));
      break;
    }
    if (used > SCENE_MOST_BYTES) {
      too_large(path, error);
      break;
    }
    if (used == capacity) continue;
    fclose(file);
    *size = used;
    return data;
  }
  fclose(file);
  free(data);
  return NULL;
}

// ---- Loading --------------------------------------------------------------------------------------------------------

static bool load_tree(const SceneSource *source, cJSON *root, Scene *scene) {
  for (int i = 0; cJSON_IsObject(root) && i < source->set_count; i++)
    if (!scene_apply_set(source, root, source->sets[i])) return false;
  return scene_parse(source, root, scene) && scene_complete(source, root, scene) &&
         scene_defs_make(source, root, scene);
}

bool scene_load_text(Scene *scene, const char *name, const char *text, size_t size, const char *const *sets,
                     int set_count, AppError *error) {
  *scene = (Scene){0};
  if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) {
    text += 3;
    size -= 3;
  }
  SceneSource source = {name, text, size, sets, set_count, error};
  if (size > SCENE_MOST_BYTES) return too_large(name, error);
  if (!scene_check_syntax(&source)) return false;
  cJSON *root = cJSON_ParseWithLength(text, size);
  if (!root) return app_fail(error, APP_FAILED, "%s: out of memory", name);
  bool good = load_tree(&source, root, scene);
  cJSON_Delete(root);
  if (good && !(scene->path = strdup(name))) good = app_fail(error, APP_FAILED, "%s: out of memory", name);
  if (!good) scene_free(scene);
  return good;
}

bool scene_load(Scene *scene, const char *path, const char *const *sets, int set_count, AppError *error) {
  *scene = (Scene){0};
  char found[4096];
  if (!path || !*path) return app_fail(error, APP_BAD_INPUT, "no scene is named");
  if (!scene_find(path, found, sizeof found)) return scene_fail_not_found(path, error);
  size_t size;
  char *text = read_file(found, &size, error);
  if (!text) return false;
  bool good = scene_load_text(scene, found, text, size, sets, set_count, error);
  free(text);
  return good;
}

/// The lists in an object, and in their items.
static void free_lists(const SceneObject *object, char *members) {
  for (int i = 0; i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    if (field->type == SCENE_OBJECT || field->type == SCENE_VARIANT) free_lists(field->object, members + field->offset);
    if (field->type != SCENE_LIST) continue;
    char *items;
    int32_t count;
    memcpy(&items, members + field->offset, sizeof items);
    memcpy(&count, members + field->count_offset, sizeof count);
    for (int32_t k = 0; k < count; k++) free_lists(field->object, items + (size_t)k * field->object->size);
    free(items);
  }
}

void scene_free(Scene *scene) {
  scene_defs_free(scene);
  free_lists(&scene_top, (char *)scene);
  free(scene->path);
  *scene = (Scene){0};
}

// ---- Use ------------------------------------------------------------------------------------------------------------

static RenderRefraction refraction_settings(const SceneRefraction *scene) {
  return (RenderRefraction){.count = scene->count,
                            .scale = scene->scale,
                            .lift = scene->lift,
                            .smoothing = (RenderSmoothing)scene->smoothing,
                            .sigma = scene->sigma,
                            .window = scene->window,
                            .reach = scene->reach,
                            .iterations = scene->iterations,
                            .view_dependent = scene->view_dependent,
                            .splashes_apart = scene->splashes_apart,
                            .surface_only = scene->surface_only};
}

static RenderRaycast raycast_settings(const SceneRaycast *scene) {
  return (RenderRaycast){.iso = scene->iso,
                         .support = scene->support,
                         .normals = (RenderNormals)scene->normals,
                         .normal_reach = scene->normal_reach,
                         .blend_d = scene->blend_d,
                         .blend_k = scene->blend_k,
                         .blend_weight = scene->blend_weight,
                         .filter_reach = scene->filter_reach,
                         .filter_angle = scene->filter_angle};
}

static RenderPalette palette_settings(const SceneCartoon *scene) {
  RenderPalette palette;
  const struct {
    float *to;
    const float *from;
  } colours[] = {
      {palette.dark, scene->dark},        {palette.medium, scene->medium},         {palette.bright, scene->bright},
      {palette.splash[0], scene->splash}, {palette.splash[1], scene->splash_dark}, {palette.ink, scene->ink},
      {palette.shade, scene->shade},      {palette.sky[0], scene->sky_top},        {palette.sky[1], scene->sky_middle},
      {palette.sky[2], scene->sky_low},   {palette.floor[0], scene->floor},        {palette.floor[1], scene->grout}};
  for (size_t i = 0; i < sizeof colours / sizeof *colours; i++)
    memcpy(colours[i].to, colours[i].from, 3 * sizeof(float));
  return palette;
}

static RenderCartoon cartoon_settings(const SceneCartoon *scene) {
  return (RenderCartoon){.scale = scene->scale,
                         .smoothing = (RenderCartoonSmoothing)scene->smoothing,
                         .kernel = scene->kernel,
                         .reach = scene->reach,
                         .separated = scene->separated,
                         .fitted = scene->fitted,
                         .range = scene->range,
                         .half_resolution = scene->half_resolution,
                         .splashes_apart = scene->splashes_apart,
                         .levels = scene->levels,
                         .bright_levels = scene->bright_levels,
                         .steady = scene->steady,
                         .bright_threshold = scene->bright_threshold,
                         .dark_threshold = scene->dark_threshold,
                         .bright_factor = scene->bright_factor,
                         .dark_factor = scene->dark_factor,
                         .reflection = scene->reflection,
                         .refraction = scene->refraction,
                         .most_reflection = scene->most_reflection,
                         .least_reflection = scene->least_reflection,
                         .most_transparency = scene->most_transparency,
                         .least_transparency = scene->least_transparency,
                         .critical_angle = scene->critical_angle,
                         .angle_interval = scene->angle_interval,
                         .clearness = scene->clearness,
                         .bending = scene->bending,
                         .outline = scene->outline,
                         .crease_angle = scene->crease_angle,
                         .palette = palette_settings(scene)};
}

static RenderHeightfield heightfield_settings(const SceneHeightfield *scene) {
  return (RenderHeightfield){.smoothing = scene->smoothing,
                             .drops = scene->drops,
                             .second_layer = scene->second_layer,
                             .mapped = scene->mapped,
                             .eyes = (RenderVirtualEyes)scene->eyes,
                             .access = (RenderMapAccess)scene->access,
                             .plane_reach = scene->plane_reach,
                             .pull_reach = scene->pull_reach,
                             .group_distance = scene->group_distance,
                             .trapezium = scene->trapezium,
                             .trapezium_a = scene->trapezium_a,
                             .trapezium_b = scene->trapezium_b,
                             .traced_caustics = scene->traced_caustics,
                             .simple_caustics = scene->simple_caustics,
                             .simple_height = scene->simple_height,
                             .simple_slope = scene->simple_slope,
                             .simple_base = scene->simple_base,
                             .dispersion = scene->dispersion};
}

RenderSettings scene_render_settings(const Scene *scene) {
  const SceneEnvironment *environment = &scene->environment;
  RenderSettings settings = render_default_settings();
  settings.style = scene->render.style;
  memcpy(settings.sun_direction, scene->light.direction, sizeof settings.sun_direction);
  memcpy(settings.sun_colour, scene->light.colour, sizeof settings.sun_colour);
  settings.sun = scene->light.sun;
  settings.shadow = scene->light.shadow;
  settings.sky = (RenderSky)environment->sky;
  memcpy(settings.sky_zenith, environment->sky_zenith, sizeof settings.sky_zenith);
  memcpy(settings.sky_horizon, environment->sky_horizon, sizeof settings.sky_horizon);
  settings.floor = (RenderFloor)environment->floor;
  settings.floor_level = environment->floor_level;
  settings.tile_size = environment->tile_size;
  memcpy(settings.floor_colour[0], environment->checker_even, sizeof settings.floor_colour[0]);
  memcpy(settings.floor_colour[1], environment->checker_odd, sizeof settings.floor_colour[1]);
  settings.container_visible = scene->container.visible;
  memcpy(settings.absorption, scene->render.absorption, sizeof settings.absorption);
  memcpy(settings.scattering, scene->render.scattering, sizeof settings.scattering);
  memcpy(settings.reflectance, scene->render.reflectance, sizeof settings.reflectance);
  settings.refractive_index = scene->render.refractive_index;
  settings.tone_map = (RenderToneMap)scene->render.tone_map;
  settings.exposure = scene->render.exposure;
  settings.points.scale = scene->render.points.scale;
  settings.raycast = raycast_settings(&scene->render.raycast);
  settings.cartoon = cartoon_settings(&scene->render.cartoon);
  settings.heightfield = heightfield_settings(&scene->render.heightfield);
  settings.refraction = refraction_settings(&scene->render.refraction);
  return settings;
}

RenderView scene_view(const Scene *scene) {
  RenderView view = {.vertical_fov = scene->camera.fov};
  memcpy(view.eye, scene->camera.eye, sizeof view.eye);
  memcpy(view.target, scene->camera.target, sizeof view.target);
  return view;
}
