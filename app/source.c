#include "app/source.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/events.h"
#include "app/particle_file.h"
#include "app/pattern.h"
#include "app/scene.h"

enum { MAX_REACH = 900 }; // m: how far from the origin files may lie, a little less than a scene's container

struct Source {
  const Options *options;
  Scene scene;
  bool has_scene;
  SimFrameBuffer *buffer;
  SimFrame frame;          // as the buffer holds it, with the number of the frame
  int64_t number;          // of the present frame, −1 before the first
  RenderSettings settings; // of the present frame
  RenderView view;

  // A scene
  SimWorld *world;
  int64_t first, end; // frames first … end − 1 are wanted

  // Particle files
  Pattern pattern;
  int64_t *numbers; // of the files that are wanted
  int64_t number_count, next;
  ParticleFile file;
  int64_t file_number;   // of `file`, −1: none
  float particle_radius; // m, where a file does not tell it
};

// ---- A scene -----------------------------------------------------------------------------------------------------------------

static bool open_scene(Source *source, AppError *error) {
  const Options *options = source->options;
  if (!scene_load(&source->scene, options->source, options->sets, options->set_count, error)) return false;
  source->has_scene = true;
  source->world = scene_world_create(&source->scene, options->threads, error);
  if (!source->world) return false;

  double frames = ceil(source->scene.simulation.duration * options->fps - 1e-6);
  source->first = options->first_frame;
  source->end = options->last_frame >= 0 ? (int64_t)options->last_frame + 1 : frames < 1 ? 1 : (int64_t)frames;
  if (source->first >= source->end)
    return app_fail(error, APP_BAD_INPUT, "--frames: the scene ends with frame %" PRId64, source->end - 1);
  SimCounts counts = sim_world_counts(source->world);
  if (!options->quiet) scene_tell_left_out(&source->scene, &counts);
  return true;
}

// From frame n to n + 1: what happens in between, then the water.
static bool advance(Source *source, AppError *error) {
  double step = 1 / source->options->fps, time = (double)source->number * step;
  sim_world_clear_profile(source->world);
  if (source->number >= 0) {
    if (!events_apply(&source->scene, time, step, source->world, NULL, NULL, error)) return false;
    SimError sim_error;
    if (!sim_world_advance(source->world, step, &sim_error))
      return app_fail(error, APP_FAILED, "frame %" PRId64 " (%.3f s): %s", source->number + 1, time + step,
                      sim_error.message);
  }
  source->number++;
  return true;
}

// The look of the present frame, from the scene and the events before it.
static bool look(Source *source, AppError *error) {
  const Options *options = source->options;
  double step = 1 / options->fps;
  source->settings = scene_render_settings(&source->scene);
  source->view = scene_view(&source->scene);
  if (source->world &&
      !events_apply(&source->scene, (double)source->number * step, step, NULL, &source->settings, &source->view, error))
    return false;
  if (options->style) source->settings.style = options->style;
  if (options->has_camera) {
    memcpy(source->view.eye, options->camera, sizeof source->view.eye);
    memcpy(source->view.target, options->camera + 3, sizeof source->view.target);
  }
  return true;
}

static SourceStep next_of_scene(Source *source, AppError *error) {
  if (source->number + 1 >= source->end) return SOURCE_END;
  do {
    if (app_interrupted()) return SOURCE_END;
    if (!advance(source, error)) return SOURCE_FAILED;
  } while (source->number < source->first);
  return SOURCE_FRAME;
}

// ---- Particle files ------------------------------------------------------------------------------------------------------------

static void drop_file(Source *source) {
  particle_file_free(&source->file);
  source->file_number = -1;
}

// Make source->file the file of this number.
static bool read_numbered(Source *source, int64_t number, AppError *error) {
  if (source->file_number == number) return true;
  drop_file(source);
  char *path = pattern_expand(&source->pattern, number);
  if (!path) return app_fail(error, APP_FAILED, "out of memory");
  bool read = particle_file_read_to_draw(path, &source->file, error);
  free(path);
  if (read) source->file_number = number;
  return read;
}

// The first file of the whole series that holds enough particles to go by, or the first of all.
static bool read_reference(Source *source, AppError *error) {
  for (int64_t i = 0; i < source->number_count; i++) {
    if (!read_numbered(source, source->numbers[i], error)) return false;
    if (source->file.count >= 2) return true;
  }
  return read_numbered(source, source->numbers[0], error);
}

// The box around all particles and their radii. False and *error when it lies too far away.
static bool file_bounds(const Source *source, const ParticleFile *file, float min[3], float max[3], AppError *error) {
  for (int k = 0; k < 3; k++) {
    min[k] = file->count ? INFINITY : 0;
    max[k] = file->count ? -INFINITY : 0;
    for (int32_t i = 0; i < file->count; i++) {
      min[k] = fminf(min[k], file->position[3 * (size_t)i + (size_t)k]);
      max[k] = fmaxf(max[k], file->position[3 * (size_t)i + (size_t)k]);
    }
    min[k] -= 2 * source->particle_radius;
    max[k] += 2 * source->particle_radius;
    if (!(min[k] >= -MAX_REACH && max[k] <= MAX_REACH))
      return app_fail(error, APP_BAD_INPUT,
                      "%s: the particles reach to %g m; only what lies within %d m of the origin is "
                      "drawn",
                      source->options->source, (double)(max[k] > MAX_REACH ? max[k] : min[k]), MAX_REACH);
  }
  return true;
}

// A scene without water around the container of the files, or around what they hold.
static bool make_scene(Source *source, const ParticleFile *file, AppError *error) {
  const Options *options = source->options;
  float min[3], max[3];
  if (!file_bounds(source, file, min, max, error)) return false;
  if (file->has_container) {
    memcpy(min, file->container.min, sizeof min);
    memcpy(max, file->container.max, sizeof max);
  }
  // Without a container the floor lies still under the first water, instead of under that of each frame.
  char text[512], floor[64] = "null";
  if (!file->has_container) snprintf(floor, sizeof floor, "%.9g", min[1]);
  int length = snprintf(text, sizeof text,
                        "{\"version\": 1, \"container\": {\"min\": [%.9g, %.9g, %.9g], \"max\": [%.9g, %.9g, %.9g], "
                        "\"visible\": %s}, \"environment\": {\"floor_level\": %s}}",
                        min[0], min[1], min[2], max[0], max[1], max[2], file->has_container ? "true" : "false", floor);
  if (!scene_load_text(&source->scene, options->source, text, (size_t)length, options->sets, options->set_count, error))
    return false;
  source->has_scene = true;
  return true;
}

// Keep the numbers in [first, last].
static void select_numbers(Source *source) {
  const Options *options = source->options;
  int64_t kept = 0;
  for (int64_t i = 0; i < source->number_count; i++) {
    int64_t number = source->numbers[i];
    bool wanted = number >= options->first_frame && (options->last_frame < 0 || number <= options->last_frame);
    if (wanted) source->numbers[kept++] = number;
  }
  source->number_count = kept;
}

static bool list_files(Source *source, AppError *error) {
  const Options *options = source->options;
  if (!pattern_parse(&source->pattern, options->source, error)) return false;
  if (source->pattern.numbered) {
    source->number_count = pattern_list(&source->pattern, &source->numbers, error);
    if (source->number_count == 0)
      app_fail(error, APP_BAD_INPUT, "%s: there is no file of this series", options->source);
    return source->number_count > 0;
  }
  source->numbers = calloc(1, sizeof *source->numbers);
  source->number_count = 1;
  return source->numbers || app_fail(error, APP_FAILED, "out of memory");
}

static bool open_files(Source *source, AppError *error) {
  if (!list_files(source, error)) return false;
  if (!read_reference(source, error)) return false;
  const ParticleFile *file = &source->file;
  source->particle_radius =
      file->particle_radius > 0 ? file->particle_radius : sim_estimate_radius(file->position, file->count);
  if (!make_scene(source, file, error)) return false;
  select_numbers(source);
  return source->number_count > 0 ||
         app_fail(error, APP_BAD_INPUT, "%s: no file of this series is in the range of --frames",
                  source->options->source);
}

static SourceStep next_of_files(Source *source, AppError *error) {
  if (source->next >= source->number_count || app_interrupted()) return SOURCE_END;
  source->number = source->numbers[source->next++];
  return read_numbered(source, source->number, error) ? SOURCE_FRAME : SOURCE_FAILED;
}

static const SimFrame *frame_of_file(Source *source, unsigned needs, AppError *error) {
  if (!read_numbered(source, source->number, error)) return NULL;
  SimParticleSet set = particle_file_set(&source->file);
  set.index = source->number;
  if (set.time <= 0) set.time = (double)source->number / source->options->fps;
  if (set.particle_radius <= 0) set.particle_radius = source->particle_radius;
  // Spray is all that a picture shows of densities and velocities; it takes both.
  if (!set.velocity) needs &= ~(unsigned)SIM_NEED_DENSITY;
  if (!(needs & SIM_NEED_DENSITY)) set.velocity = NULL;
  SimError cause;
  const SimFrame *frame = sim_frame_from_particles(&set, needs, source->options->threads, source->buffer, &cause);
  // The frame holds all of it; a large file is not kept beside it while it is drawn.
  drop_file(source);
  if (!frame) app_fail(error, APP_FAILED, "frame %" PRId64 ": %s", source->number, cause.message);
  return frame;
}

static const SimFrame *frame_of_scene(Source *source, unsigned needs, AppError *error) {
  SimError cause;
  const SimFrame *frame = sim_world_frame(source->world, needs, source->buffer, &cause);
  if (!frame) app_fail(error, APP_FAILED, "frame %" PRId64 ": %s", source->number, cause.message);
  return frame;
}

// ---- Both ----------------------------------------------------------------------------------------------------------------------

Source *source_open(const Options *options, AppError *error) {
  Source *source = calloc(1, sizeof *source);
  if (source) source->buffer = sim_frame_buffer_create();
  if (!source || !source->buffer) {
    app_fail(error, APP_FAILED, "out of memory");
    free(source);
    return NULL;
  }
  source->options = options;
  source->number = source->file_number = -1;
  bool opened = particle_file_named(options->source) ? open_files(source, error) : open_scene(source, error);
  if (opened) return source;
  source_close(source);
  return NULL;
}

void source_close(Source *source) {
  if (!source) return;
  sim_world_destroy(source->world);
  sim_frame_buffer_destroy(source->buffer);
  if (source->has_scene) scene_free(&source->scene);
  particle_file_free(&source->file);
  free(source->numbers);
  free(source);
}

int64_t source_count(const Source *source) {
  return source->world ? source->end - source->first : source->number_count;
}

int64_t source_first(const Source *source) {
  return source->world ? source->first : source->numbers[0];
}

SourceStep source_next(Source *source, AppError *error) {
  SourceStep step = source->world ? next_of_scene(source, error) : next_of_files(source, error);
  if (step == SOURCE_FRAME && !look(source, error)) return SOURCE_FAILED;
  return step;
}

const SimFrame *source_frame(Source *source, unsigned needs, AppError *error) {
  const SimFrame *frame = source->world ? frame_of_scene(source, needs, error) : frame_of_file(source, needs, error);
  if (!frame) return NULL;
  source->frame = *frame;
  source->frame.index = source->number;
  return &source->frame;
}

int64_t source_number(const Source *source) {
  return source->number;
}

const RenderSettings *source_settings(const Source *source) {
  return &source->settings;
}

const RenderView *source_view(const Source *source) {
  return &source->view;
}

const Scene *source_scene(const Source *source) {
  return &source->scene;
}

SimWorld *source_world(Source *source) {
  return source->world;
}
