// What makes settings and views acceptable. Internal to the renderer.
#ifndef LIDO_RENDER_SETTINGS_H
#define LIDO_RENDER_SETTINGS_H

#include "render/picture.h"

bool render_settings_check(const RenderSettings *settings, RenderError *error);
bool render_view_check(const RenderView *view, RenderError *error);

#endif
