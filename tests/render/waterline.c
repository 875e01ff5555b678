#include "tests/render/waterline.h"

#include <math.h>
#include <stdlib.h>

// ---- Colours ---------------------------------------------------------------------------------------------------------

RenderSettings waterline_settings(void) {
  RenderSettings settings = harness_pinned_settings();
  settings.style = "heightfield";
  settings.floor_level = NAN;
  for (int k = 0; k < 3; ++k) {
    settings.sky_zenith[k] = settings.sky_horizon[k] = 0.8f;
    settings.absorption[k] = settings.scattering[k] = 0;
    settings.floor_colour[0][k] = settings.floor_colour[1][k] = 0;
  }
  settings.heightfield.traced_caustics = false;
  settings.heightfield.drops = false;
  return settings;
}

void waterline_paint(SimObstacle *obstacle, int hue) {
  for (int k = 0; k < 3; ++k) obstacle->colour[k] = hue == 0 ? 0.1f : hue >> k & 1 ? 1 : 0;
}

// White that the water mirrors raises all three alike; what it mirrors of bodies is faint.
static int hue_at(const WaterlinePicture *p, int x, int y) {
  if (x < 0 || x >= p->width || y < 0 || y >= p->height) return 0;
  const uint8_t *rgb = p->rgb + 3 * ((size_t)y * (size_t)p->width + (size_t)x);
  int least = 255, most = 0, hue = 0;
  for (int k = 0; k < 3; ++k) {
    least = rgb[k] < least ? rgb[k] : least;
    most = rgb[k] > most ? rgb[k] : most;
  }
  if (most - least < 80) return 0;
  for (int k = 0; k < 3; ++k) hue |= (2 * (rgb[k] - least) > most - least) << k;
  return hue;
}

// ---- One body --------------------------------------------------------------------------------------------------------

enum { ABOVE = 14, BELOW = 8, INSIDE = 4, FARTHEST = 15 }; // rows of the two fits; pixels; of WATERLINE_WIDTH

typedef struct Body {
  const WaterlinePicture *picture;
  int hue, scale;  // scale: pixels for one of WATERLINE_WIDTH
  int (*run)[2];   // (height) first and last pixel of each row's longest run above the water; first > last: none
  int top, bottom; // rows with such runs
} Body;

static bool is_above(const Body *b, int x, int y) {
  const WaterlinePicture *p = b->picture;
  return hue_at(p, x, y) == b->hue && !(p->water[(size_t)y * (size_t)p->width + (size_t)x] > 0);
}

static void find_run(Body *b, int y) {
  int begin = 0, *run = b->run[y];
  run[0] = 1;
  run[1] = 0;
  for (int x = 0; x <= b->picture->width; ++x) {
    if (x < b->picture->width && is_above(b, x, y)) continue;
    if (x - begin > run[1] - run[0] + 1) {
      run[0] = begin;
      run[1] = x - 1;
    }
    begin = x + 1;
  }
}

// false: nothing of it is above the water.
static bool find_body(Body *b) {
  b->top = b->picture->height;
  b->bottom = -1;
  for (int y = 0; y < b->picture->height; ++y) {
    find_run(b, y);
    if (b->run[y][0] > b->run[y][1]) continue;
    b->top = y < b->top ? y : b->top;
    b->bottom = y;
  }
  return b->bottom - b->top >= 2 * ABOVE * b->scale;
}

typedef struct Line {
  double at, slope; // x = at + slope · y
  int count;
} Line;

typedef struct Fit {
  double y, x, yy, xy;
  int count;
} Fit;

static void fit_add(Fit *f, double y, double x) {
  f->y += y;
  f->x += x;
  f->yy += y * y;
  f->xy += x * y;
  ++f->count;
}

static Line fit_line(const Fit *f) {
  if (f->count < 4) return (Line){0, 0, f->count};
  const double n = f->count, slope = (f->xy - f->x * f->y / n) / (f->yy - f->y * f->y / n);
  return (Line){(f->x - slope * f->y) / n, slope, f->count};
}

static double line_at(Line line, double y) {
  return line.at + line.slope * y;
}

// Is another body beside this pixel on that side, so that the border is not this body's own?
static bool is_hidden(const Body *b, int x, int y, int outward) {
  const int beyond = hue_at(b->picture, x + outward, y);
  return beyond != 0 && beyond != b->hue;
}

// The line of the outline above the water over rows first … last.
static Line line_above(const Body *b, int side, int first, int last) {
  Fit fit = {0};
  for (int y = first > b->top ? first : b->top; y <= last; ++y) {
    const int x = b->run[y][side];
    if (b->run[y][0] <= b->run[y][1] && !is_hidden(b, x, y, side == 0 ? -1 : 1)) fit_add(&fit, y, x);
  }
  return fit_line(&fit);
}

// The last row in which the outline above the water still runs along its line: there this side goes into the water.
static int find_entry(const Body *b, int side) {
  const int quarter = (b->bottom - b->top) / 4, middle = b->top + 2 * quarter;
  const Line line = line_above(b, side, b->top + quarter, middle);
  if (line.count < 4) return -1;
  int y = middle;
  while (y < b->bottom && fabs(b->run[y + 1][side] - line_at(line, y + 1)) <= 1.25) ++y;
  return y;
}

// The last pixel outwards that belongs to the body, in whatever way it is seen, from a pixel that should; −1: another body is
// in the way, −2: there is none.
static int border_at(const Body *b, int x, int y, int outward) {
  const int start = x;
  while (hue_at(b->picture, x, y) != b->hue) {
    if (hue_at(b->picture, x, y) != 0) return -1;
    x -= outward;
    if (abs(x - start) > FARTHEST * b->scale) return -2;
  }
  while (hue_at(b->picture, x + outward, y) == b->hue) x += outward;
  return is_hidden(b, x, y, outward) ? -1 : x;
}

static void measure_side(const Body *b, int side, WaterlineBreaks *breaks) {
  const int outward = side == 0 ? -1 : 1, entry = find_entry(b, side);
  if (entry < 0 || entry + BELOW * b->scale + 1 >= b->picture->height) return;
  const Line above = line_above(b, side, entry - ABOVE * b->scale, entry - 1);
  Fit fit = {0};
  int lost = 0;
  for (int y = entry + 2; y <= entry + BELOW * b->scale; ++y) {
    const int x = border_at(b, (int)lround(line_at(above, y)) - outward * INSIDE * b->scale, y, outward);
    lost += x == -2;
    if (x >= 0) fit_add(&fit, y, x);
  }
  const Line below = fit_line(&fit);
  if (above.count < 4 || (below.count < 4 && lost < 4)) return;
  const double gap = fabs(line_at(above, entry + 0.5) - line_at(below, entry + 0.5)) / b->scale;
  breaks->gap = fmax(breaks->gap, lost >= 4 ? FARTHEST : gap);
  ++breaks->joins;
}

// Pixels of a column between what is above the water and what is seen through it; 0 where the column leaves the body by its side.
static int seam_of_column(const Body *b, int x, int from, const Line side[2]) {
  int y = from, seam = 0;
  while (y < b->picture->height && is_above(b, x, y)) ++y;
  while (seam < FARTHEST * b->scale && hue_at(b->picture, x, y + seam) != b->hue) {
    const int at = y + seam;
    if (hue_at(b->picture, x, at) != 0 || at >= b->picture->height) return 0;
    if (x < line_at(side[0], at) + 1.5 || x > line_at(side[1], at) - 1.5) return 0;
    ++seam;
  }
  return seam;
}

static void measure_seams(const Body *b, WaterlineBreaks *breaks) {
  const int entry[2] = {find_entry(b, 0), find_entry(b, 1)};
  if (entry[0] < 0 || entry[1] < 0) return;
  Line side[2];
  for (int k = 0; k < 2; ++k) side[k] = line_above(b, k, entry[k] - ABOVE * b->scale, entry[k] - 1);
  if (side[0].count < 4 || side[1].count < 4) return;
  const int from = (entry[0] < entry[1] ? entry[0] : entry[1]) - 2;
  for (int x = b->run[from][0] + 1; x < b->run[from][1]; ++x) {
    breaks->seam = fmax(breaks->seam, (double)seam_of_column(b, x, from, side) / b->scale);
  }
}

WaterlineBreaks waterline_measure(const WaterlinePicture *picture, int hue) {
  WaterlineBreaks breaks = {0};
  Body body = {.picture = picture,
               .hue = hue,
               .scale = picture->width / WATERLINE_WIDTH,
               .run = malloc(sizeof(int[2]) * (size_t)picture->height)};
  assert_non_null(body.run);
  if (find_body(&body)) {
    for (int side = 0; side < 2; ++side) measure_side(&body, side, &breaks);
    measure_seams(&body, &breaks);
  }
  free(body.run);
  return breaks;
}

// ---- A frame ---------------------------------------------------------------------------------------------------------

WaterlineBreaks waterline_of_frame(Harness *harness, const SimFrame *frame, const RenderView *view,
                                   const RenderSettings *settings) {
  uint8_t *rgb = harness_draw(harness, frame, view, settings);
  float *water = harness_layer(harness, "depth", 1, frame, view, settings);
  const WaterlinePicture picture = {harness->width, harness->height, rgb, water};
  WaterlineBreaks all = {0};
  for (int hue = 1; hue <= 6; ++hue) {
    const WaterlineBreaks breaks = waterline_measure(&picture, hue);
    all.joins += breaks.joins;
    all.gap = fmax(all.gap, breaks.gap);
    all.seam = fmax(all.seam, breaks.seam);
  }
  free(rgb);
  free(water);
  return all;
}
