// Every style there is. A new one is one more row.
#include "render/style.h"

#include <string.h>

extern const RenderStyle style_cartoon;
extern const RenderStyle style_heightfield;
extern const RenderStyle style_points;
extern const RenderStyle style_raycast;
extern const RenderStyle style_refraction;

const RenderStyle *const render_styles[] = {
    &style_points,
    &style_refraction,
    &style_raycast,
    &style_cartoon,
    &style_heightfield,
    NULL,
};

const RenderStyle *render_style_find(const char *name) {
  for (int i = 0; name != NULL && render_styles[i] != NULL; ++i) {
    if (strcmp(render_styles[i]->name, name) == 0) return render_styles[i];
  }
  return NULL;
}

int32_t render_style_count(void) {
  return (int32_t)(sizeof render_styles / sizeof render_styles[0]) - 1;
}

const char *render_style_name(int32_t index) {
  return index >= 0 && index < render_style_count() ? render_styles[index]->name : NULL;
}

const char *render_style_summary(int32_t index) {
  return index >= 0 && index < render_style_count() ? render_styles[index]->summary : NULL;
}

unsigned render_style_needs(const char *name, const RenderSettings *settings) {
  const RenderStyle *style = render_style_find(name);
  if (style == NULL) return 0;
  return style->needs | (style->needs_more != NULL && settings != NULL ? style->needs_more(settings) : 0);
}

bool render_style_exists(const char *name) {
  return render_style_find(name) != NULL;
}
