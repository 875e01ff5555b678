#include "app/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/context_glfw.h"
#include "app/events.h"
#include "app/image.h"
#include "app/live.h"
#include "app/stats.h"
#include "app/window_input.h"

enum { HUD_SIZE = 2048 };

typedef struct Window {
  const Scene *scene;
  const Options *options;
  char name[SCENE_TEXT_SIZE]; // of the scene, for the title
  GLFWwindow *glfw;
  Render *render;
  Live *live;
  Stats *stats;
  WindowInput input;

  // What is drawn
  RenderSettings settings; // its style is the one wanted
  const char *shown_style; // the one that the present frame has everything for
  const char *layer;       // NULL: the picture
  int width, height;       // pixels that the renderer draws
  const char *event_style; // what the timeline said for the last frame, to see it change
  RenderView event_view;
  RenderView home; // where C brings the eye back to

  // What moves
  InteractStrength strength;
  InteractLean lean;
  double due;       // s, when the next frame may start
  double hand_time; // s, when the hand's pushes were last taken

  // What is told
  char notice[1100];                          // for a while, or until the next one
  double notice_end;                          // s
  double draw_ms, pictures_per_second, speed; // running means
  double last_drawn, last_frame_time;         // s
  char title[256];
} Window;

static void notify(Window *window, const char *format, const char *what) {
  snprintf(window->notice, sizeof window->notice, format, what);
  window->notice_end = glfwGetTime() + 4;
  window->input.changed = true;
}

static double running_mean(double mean, double value) {
  return mean > 0 ? 0.9 * mean + 0.1 * value : value;
}

// ---- Style and layer --------------------------------------------------------------------------------------------------

static void set_style(Window *window, const char *style) {
  window->settings.style = style;
  window->layer = NULL;
  notify(window, "style: %s", style);
}

static int style_index(const char *style) {
  for (int i = 0; i < render_style_count(); i++)
    if (!strcmp(render_style_name(i), style)) return i;
  return 0;
}

static void choose_style(Window *window) {
  WindowInput *input = &window->input;
  if (input->next_style > 0)
    set_style(window,
              render_style_name((style_index(window->settings.style) + input->next_style) % render_style_count()));
  if (input->style >= render_style_count()) notify(window, "there is no style with this number%s", "");
  if (input->style >= 0 && input->style < render_style_count()) set_style(window, render_style_name(input->style));
  input->next_style = 0;
  input->style = -1;
}

static int layer_index(const char *style, const char *layer) {
  for (int i = 0; layer && i < render_layer_count(style); i++)
    if (!strcmp(render_layer_name(style, i), layer)) return i;
  return -1;
}

// The picture, then every layer of the style, then the picture again.
static void choose_layer(Window *window) {
  for (; window->input.next_layer > 0; window->input.next_layer--) {
    int next = layer_index(window->shown_style, window->layer) + 1;
    window->layer =
        next < render_layer_count(window->shown_style) ? render_layer_name(window->shown_style, next) : NULL;
    notify(window, "layer: %s", window->layer ? window->layer : "none, the picture");
  }
}

// ---- The simulation ---------------------------------------------------------------------------------------------------

// What the timeline says about style and eye, when it says something new: hands may change both in between. What the
// command line says stays.
static void follow_timeline(Window *window) {
  double step = 1 / window->options->fps;
  RenderSettings settings = {.style = NULL};
  RenderView view = scene_view(window->scene);
  events_apply(window->scene, (double)live_frame(window->live)->frame.index * step, step, NULL, &settings, &view, NULL);
  if (settings.style && settings.style != window->event_style && !window->options->style)
    set_style(window, settings.style);
  window->event_style = settings.style;
  bool moved = memcmp(&view, &window->event_view, sizeof view) != 0;
  window->event_view = view;
  if (!moved || window->options->has_camera) return;
  window->home = view;
  Camera camera = camera_from_view(&view, 1);
  camera.min_distance = fminf(window->input.camera.min_distance, camera.distance);
  camera.max_distance = fmaxf(window->input.camera.max_distance, camera.distance);
  window->input.camera = camera;
}

// What the hand can grasp: the bodies as they are seen.
static void show_bodies(Window *window) {
  const SimFrame *frame = &live_frame(window->live)->frame;
  window->input.bodies = (GrabBodies){frame->obstacle_count, frame->obstacles, window->scene->defs.obstacles};
  window->input.container = frame->container;
}

static void take_result(Window *window) {
  switch (live_poll(window->live, 0)) {
  case LIVE_NOTHING:
    return;
  case LIVE_FAILURE:
    fprintf(stderr, "lido: %s\n", live_failure(window->live));
    break;
  case LIVE_NEW_FRAME: {
    show_bodies(window);
    double now = glfwGetTime(), elapsed = now - window->last_frame_time;
    window->last_frame_time = now;
    if (elapsed > 0) window->speed = running_mean(window->speed, 1 / (window->options->fps * elapsed));
    follow_timeline(window);
  }
  }
  window->input.changed = true;
}

// Lean the tank as keys and hand want it. True when gravity is to be set.
static bool lean(Window *window) {
  const WindowInput *input = &window->input;
  float goal[2];
  interact_lean_goal(&input->container, input->lean_keys, input->lean_drag, input->height, goal);
  return interact_lean_step(&window->lean, goal, 1 / window->options->fps);
}

static LiveInput gather(Window *window) {
  RenderView view = camera_view(&window->input.camera);
  double step = 1 / window->options->fps, now = glfwGetTime();
  LiveInput input = {.needs = render_style_needs(window->settings.style, &window->settings),
                     .set_gravity = lean(window)};
  input.push_count = interact_take(&window->input.hand, &window->strength, &view, window->input.width,
                                   window->input.height, now - window->hand_time, input.pushes);
  window->hand_time = now;
  if (window->input.grab.moved) {
    input.drag = true;
    input.body = window->input.grab.body;
    memcpy(input.position, window->input.grab.target, sizeof input.position);
    window->input.grab.moved = false;
  }
  if (input.set_gravity) {
    float gravity[3];
    events_gravity(window->scene, ((double)live_frame(window->live)->frame.index + 0.5) * step, gravity);
    interact_lean(gravity, &view, window->lean.angle[0], window->lean.angle[1], input.gravity);
  }
  return input;
}

static bool last_frame_reached(const Window *window) {
  return window->options->last_frame >= 0 && live_frame(window->live)->frame.index >= window->options->last_frame;
}

static bool may_advance(const Window *window) {
  const WindowInput *input = &window->input;
  return !live_failure(window->live) && !last_frame_reached(window) && input->width > 0 &&
         (!input->paused || input->steps > 0);
}

static void reset(Window *window) {
  window->lean = (InteractLean){0};
  // The body slips out of the hand: it is back at its start.
  if (window->input.drag == WINDOW_DRAG_BODY) window->input.drag = WINDOW_DRAG_NONE;
  window->input.grab = (Grab){0};
  window->notice[0] = '\0';
  live_reset(window->live, render_style_needs(window->settings.style, &window->settings));
  window->input.reset = false;
}

// Give the idle worker its next work, if there is any and it is time.
static void feed(Window *window) {
  if (live_busy(window->live)) return;
  WindowInput *input = &window->input;
  double now = glfwGetTime();
  if (input->reset) {
    reset(window);
  } else if (may_advance(window)) {
    if (!input->paused && now < window->due) return;
    window->due = fmax(window->due + 1 / window->options->fps, now);
    if (input->steps > 0) input->steps--;
    LiveInput next = gather(window);
    live_advance(window->live, &next);
  } else {
    // Standing still: the hand grasps at nothing, but another style may need more of the same frame.
    unsigned needs = render_style_needs(window->settings.style, &window->settings);
    if (input->hand.released) input->hand = (Interact){0};
    window->last_frame_time = window->hand_time = window->due = now;
    if (needs & ~live_frame(window->live)->needs) live_refresh(window->live, needs);
  }
}

// ---- Drawing ----------------------------------------------------------------------------------------------------------

static bool fit_size(Window *window, AppError *error) {
  if (window->width == window->input.width && window->height == window->input.height) return true;
  RenderError reason;
  if (!render_resize(window->render, window->input.width, window->input.height, &reason))
    return app_fail(error, APP_FAILED, "%s", reason.message);
  window->width = window->input.width;
  window->height = window->input.height;
  return true;
}

// The picture alone, without text. The old style stays until a frame holds what the new one needs.
static bool draw_picture(Window *window, AppError *error) {
  const LiveFrame *frame = live_frame(window->live);
  if (!(render_style_needs(window->settings.style, &window->settings) & ~frame->needs))
    window->shown_style = window->settings.style;
  choose_layer(window);
  if (layer_index(window->shown_style, window->layer) < 0) window->layer = NULL;
  RenderSettings settings = window->settings;
  settings.style = window->shown_style;
  RenderView view = camera_view(&window->input.camera);
  RenderError reason;
  render_show_layer(window->render, window->layer);
  if (!render_draw(window->render, &frame->frame, &view, &settings, &reason))
    return app_fail(error, APP_FAILED, "%s", reason.message);
  return true;
}

// The first free name out/picture_NNN.png. A picture that cannot be saved is told, it does not end the window.
static void save_picture(Window *window) {
  window->input.picture = false;
  char path[64];
  int number = 0;
  FILE *taken = NULL;
  do {
    snprintf(path, sizeof path, "out/picture_%03d.png", ++number);
    taken = fopen(path, "rb");
    if (taken) fclose(taken);
  } while (taken && number < 100000);
  AppError error;
  uint8_t *rgb = malloc((size_t)window->width * (size_t)window->height * 3);
  if (!rgb) {
    notify(window, "no memory for the picture%s", "");
    return;
  }
  render_read_rgb8(window->render, rgb);
  bool saved = image_write_png(path, rgb, window->width, window->height, &error);
  free(rgb);
  notify(window, saved ? "saved as %s" : "%s", saved ? path : error.message);
}

// A block of text with its top edge at y, or with its bottom edge there. Returns the y below it.
static int draw_block(Window *window, int y, bool upwards, const char *text) {
  char block[HUD_SIZE];
  int lines = 0, columns = 0;
  hud_measure(text, &lines, &columns);
  if (lines == 0) return y;
  int scale = hud_scale(window->input.scale, window->width, window->height), line = HUD_LINE_HEIGHT * scale;
  if (upwards) y -= lines * line;
  render_text(window->render, HUD_GLYPH_WIDTH * scale, y, scale, hud_block(text, block, sizeof block));
  return y + (lines + 1) * line;
}

static char *figures_text(const Window *window, char *text, size_t size) {
  const LiveFrame *frame = live_frame(window->live);
  HudFigures figures = {.style = window->shown_style,
                        .layer = window->layer,
                        .particles = frame->frame.count,
                        .frame = frame->frame.index,
                        .time = frame->frame.time,
                        .frames_per_second = window->pictures_per_second,
                        .simulate_ms = frame->milliseconds,
                        .speed = may_advance(window) ? window->speed : 0,
                        .draw_ms = window->draw_ms,
                        .paused = window->input.paused};
  return hud_figures(&figures, text, size);
}

// Figures and help at the top; notices at the bottom, where that the simulation failed stays until it is reset.
static void draw_hud(Window *window) {
  char text[HUD_SIZE], message[1200] = "";
  const int margin = HUD_LINE_HEIGHT;
  int y = margin;
  if (window->input.figures) y = draw_block(window, y, false, figures_text(window, text, sizeof text));
  if (window->input.help) draw_block(window, y, false, hud_help(text, sizeof text));
  const char *failure = live_failure(window->live);
  if (failure)
    snprintf(message, sizeof message, "The simulation stopped: %s. Press R to start again.", failure);
  else if (glfwGetTime() < window->notice_end)
    snprintf(message, sizeof message, "%s", window->notice);
  int scale = hud_scale(window->input.scale, window->width, window->height);
  hud_wrap(message, window->width / (HUD_GLYPH_WIDTH * scale) - 4, text, sizeof text);
  draw_block(window, window->height - margin, true, text);
}

static void update_title(Window *window) {
  char title[sizeof window->title];
  hud_title(window->name, live_frame(window->live)->frame.index, window->input.paused, title, sizeof title);
  if (!strcmp(title, window->title)) return;
  memcpy(window->title, title, sizeof title);
  glfwSetWindowTitle(window->glfw, title);
}

static bool draw(Window *window, AppError *error) {
  window->input.changed = false;
  double begin = glfwGetTime();
  if (!fit_size(window, error) || !draw_picture(window, error)) return false;
  if (window->input.picture) save_picture(window);
  draw_hud(window);
  render_present(window->render, window->width, window->height);
  window->draw_ms = running_mean(window->draw_ms, 1e3 * (glfwGetTime() - begin));
  glfwSwapBuffers(window->glfw);
  if (window->last_drawn > 0)
    window->pictures_per_second = running_mean(window->pictures_per_second, 1 / fmax(begin - window->last_drawn, 1e-4));
  window->last_drawn = begin;
  update_title(window);
  return true;
}

// ---- The loop ---------------------------------------------------------------------------------------------------------

// Sleep until something may happen: an event, the end of a job, the time for the next frame, the end of a notice.
static void wait_for_events(Window *window) {
  double now = glfwGetTime(), seconds = 0.25;
  if (window->input.width == 0) {
    glfwWaitEventsTimeout(seconds);
    return;
  }
  if (live_busy(window->live))
    seconds = 0.002;
  else if (may_advance(window))
    seconds = fmin(seconds, window->due - now);
  if (now < window->notice_end) seconds = fmin(seconds, window->notice_end - now + 1e-3);
  if (seconds > 0 && !window->input.changed)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
  if (now < window->notice_end && glfwGetTime() >= window->notice_end) window->input.changed = true;
}

static void act(Window *window) {
  if (window->input.recentre) {
    Camera limits = window->input.camera;
    window->input.camera = camera_from_view(&window->home, 1);
    window->input.camera.min_distance = limits.min_distance;
    window->input.camera.max_distance = limits.max_distance;
    window->input.recentre = false;
  }
  choose_style(window);
}

static bool loop(Window *window, AppError *error) {
  int64_t told = -1; // frame of the last line of --stats
  while (!window->input.quit && !app_interrupted()) {
    wait_for_events(window);
    window_input_poll(window->glfw, &window->input);
    act(window);
    take_result(window);
    bool last = last_frame_reached(window);
    if (!window->stats) feed(window);
    if ((window->input.changed || last) && window->input.width > 0 && !draw(window, error)) return false;
    if (window->stats && !live_busy(window->live)) {
      const SimFrame *frame = &live_frame(window->live)->frame;
      if (frame->index != told) stats_frame(window->stats, frame, live_world(window->live), window->render);
      told = frame->index;
      feed(window);
    }
    if (last) return true;
    if (window->options->last_frame >= 0 && live_failure(window->live))
      return app_fail(error, APP_FAILED, "%s", live_failure(window->live));
  }
  return true;
}

// ---- Start and end ----------------------------------------------------------------------------------------------------

static void name_scene(Window *window) {
  const char *source = window->options->source, *slash = strrchr(source, '/');
  snprintf(window->name, sizeof window->name, "%s",
           window->scene->name[0] ? window->scene->name
           : slash                ? slash + 1
                                  : source);
}

static void set_up_eye(Window *window) {
  const SimContainer *container = &live_frame(window->live)->frame.container;
  float size = 0;
  for (int k = 0; k < 3; k++) size = hypotf(size, container->max[k] - container->min[k]);
  window->event_view = window->home = scene_view(window->scene);
  if (window->options->has_camera) {
    memcpy(window->home.eye, window->options->camera, sizeof window->home.eye);
    memcpy(window->home.target, window->options->camera + 3, sizeof window->home.target);
  }
  window->input.camera = camera_from_view(&window->home, size);
}

static bool open_window(Window *window, AppError *error) {
  const Options *options = window->options;
  const GlfwWindowDef def = {.title = "Lido", .width = options->width, .height = options->height, .visible = true};
  AppError why;
  window->glfw = context_glfw_open(&def, &why);
  if (!window->glfw)
    return app_fail(error, APP_FAILED, "%s; 'lido render' makes pictures without a window", why.message);
  glfwSwapInterval(1);
  glfwGetFramebufferSize(window->glfw, &window->width, &window->height);
  RenderError reason;
  window->render = render_create(window->width, window->height, &reason);
  return window->render || app_fail(error, APP_FAILED, "%s", reason.message);
}

static bool start(Window *window, AppError *error) {
  const Options *options = window->options;
  window->settings = scene_render_settings(window->scene);
  if (options->style) window->settings.style = options->style;
  window->shown_style = window->settings.style;
  if (options->layer && layer_index(window->shown_style, options->layer) < 0)
    return app_fail(error, APP_BAD_INPUT, "--layer: style %s has no layer '%s'", window->shown_style, options->layer);
  window->layer = options->layer;
  name_scene(window);
  if (!open_window(window, error)) return false;
  window->live = live_create(window->scene, options->fps, options->threads,
                             render_style_needs(window->shown_style, &window->settings), error);
  if (!window->live) return false;
  if (options->stats && !(window->stats = stats_open(options->stats, error))) return false;
  window->strength = interact_strength(&live_frame(window->live)->frame.container, window->scene->simulation.gravity,
                                       window->scene->simulation.particle_radius);
  if (!options->quiet) scene_tell_left_out(window->scene, &live_frame(window->live)->counts);
  set_up_eye(window);
  show_bodies(window);
  window_input_connect(window->glfw, &window->input);
  window->due = window->hand_time = window->last_frame_time = glfwGetTime();
  notify(window, "%s", "H: help");
  return true;
}

static void stop(Window *window) {
  // The frame at work may take a while: do not leave a window about that no longer answers.
  if (window->glfw) glfwHideWindow(window->glfw);
  stats_abort(window->stats);
  live_destroy(window->live);
  render_destroy(window->render);
  context_glfw_close(window->glfw);
}

bool window_run(const Scene *scene, const Options *options, AppError *error) {
  Window window = {.scene = scene, .options = options};
  bool ok = start(&window, error) && loop(&window, error);
  if (ok) {
    ok = stats_close(window.stats, error);
    window.stats = NULL;
  }
#ifndef NDEBUG
  if (ok && render_gl_error_count(window.render) > 0)
    ok = app_fail(error, APP_FAILED, "OpenGL reported %d errors", (int)render_gl_error_count(window.render));
#endif
  stop(&window);
  return ok;
}
