// Liquids by name. Refractive indices are measured ones (sodium light, room temperature); absorption and scattering are chosen
// for the look of a tank about a metre across, where the true ones of milk or juice would be a wall of paint; reflectances of
// metals are measured ones, linear (mercury, gold, copper at 630, 530, 465 nm).
#include <string.h>

#include "render/render.h"

static const RenderMaterial materials[] = {
    {"water", {3.2f, 0.68f, 0.46f}, {0.14f, 0.34f, 0.36f}, {0}, 1.333f},
    {"milk", {0.6f, 1.2f, 3.2f}, {60, 58, 52}, {0}, 1.35f},
    {"juice", {0.4f, 6, 40}, {18, 12, 4}, {0}, 1.35f},
    {"oil", {0.5f, 2.2f, 14}, {0.3f, 0.25f, 0.05f}, {0}, 1.47f},
    {"cola", {9, 30, 60}, {1.2f, 0.6f, 0.3f}, {0}, 1.345f},
    {"ink", {26, 22, 6}, {0.4f, 0.6f, 2}, {0}, 1.335f},
    {"metal", {0}, {0}, {0.78f, 0.78f, 0.78f}, 1.333f},
    {"gold", {0}, {0}, {1, 0.71f, 0.29f}, 1.333f},
    {"copper", {0}, {0}, {0.95f, 0.64f, 0.54f}, 1.333f},
};

const RenderMaterial *render_material(int32_t index) {
  return index >= 0 && index < (int32_t)(sizeof materials / sizeof materials[0]) ? &materials[index] : NULL;
}

const RenderMaterial *render_material_find(const char *name) {
  for (int32_t i = 0; name != NULL && render_material(i) != NULL; ++i) {
    if (strcmp(materials[i].name, name) == 0) return &materials[i];
  }
  return NULL;
}

void render_use_material(RenderSettings *settings, const RenderMaterial *material) {
  memcpy(settings->absorption, material->absorption, sizeof settings->absorption);
  memcpy(settings->scattering, material->scattering, sizeof settings->scattering);
  memcpy(settings->reflectance, material->reflectance, sizeof settings->reflectance);
  settings->refractive_index = material->refractive_index;
}
