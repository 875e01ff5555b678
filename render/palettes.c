// Palettes of the style "cartoon". The colours were chosen on the screen: what is written here is linear light, c for a
// byte b of sRGB being ((b/255 + 0.055)/1.055)^2.4. Tones are dimmed by their level of light (Eqs. 6, 7), so that a dark
// C_f is brighter here than in the picture.
#include "render/render.h"

static const RenderNamedPalette palettes[] = {
    // Clear southern water on pale stone.
    {"lagoon",
     0.3f,
     0.8f,
     {.dark = {0.02f, 0.42f, 0.90f},
      .medium = {0.015f, 0.42f, 0.85f},
      .bright = {0.03f, 0.52f, 0.78f},
      .splash = {{0.93f, 0.98f, 1.0f}, {0.45f, 0.80f, 0.93f}},
      .ink = {0.010f, 0.040f, 0.130f},
      .shade = {0.56f, 0.55f, 0.72f},
      .sky = {{0.10f, 0.40f, 0.85f}, {0.30f, 0.62f, 0.93f}, {0.78f, 0.92f, 0.98f}},
      .floor = {{0.87f, 0.76f, 0.56f}, {0.66f, 0.53f, 0.35f}}}},
    // Brush and paper.
    {"ink",
     0.25f,
     0.6f,
     {.dark = {0.20f, 0.20f, 0.22f},
      .medium = {0.42f, 0.42f, 0.43f},
      .bright = {0.78f, 0.77f, 0.74f},
      .splash = {{0.96f, 0.95f, 0.91f}, {0.60f, 0.59f, 0.57f}},
      .ink = {0.006f, 0.006f, 0.008f},
      .shade = {0.55f, 0.54f, 0.53f},
      .sky = {{0.72f, 0.71f, 0.67f}, {0.82f, 0.81f, 0.77f}, {0.93f, 0.92f, 0.88f}},
      .floor = {{0.88f, 0.87f, 0.82f}, {0.62f, 0.61f, 0.57f}}}},
    // Molten rock at night.
    {"lava",
     0.2f,
     0,
     {.dark = {0.75f, 0.04f, 0.005f},
      .medium = {1.0f, 0.20f, 0.008f},
      .bright = {1.0f, 0.62f, 0.06f},
      .splash = {{1.0f, 0.85f, 0.28f}, {1.0f, 0.38f, 0.02f}},
      .ink = {0.035f, 0.003f, 0.006f},
      .shade = {0.40f, 0.22f, 0.25f},
      .sky = {{0.020f, 0.010f, 0.035f}, {0.080f, 0.020f, 0.045f}, {0.36f, 0.07f, 0.030f}},
      .floor = {{0.055f, 0.032f, 0.038f}, {0.140f, 0.032f, 0.014f}}}},
    // A grey sea under heavy clouds.
    {"storm",
     0.45f,
     0.35f,
     {.dark = {0.07f, 0.17f, 0.24f},
      .medium = {0.10f, 0.27f, 0.33f},
      .bright = {0.30f, 0.52f, 0.53f},
      .splash = {{0.86f, 0.92f, 0.91f}, {0.42f, 0.57f, 0.60f}},
      .ink = {0.006f, 0.014f, 0.025f},
      .shade = {0.45f, 0.50f, 0.58f},
      .sky = {{0.10f, 0.13f, 0.18f}, {0.20f, 0.25f, 0.30f}, {0.45f, 0.50f, 0.50f}},
      .floor = {{0.31f, 0.35f, 0.35f}, {0.18f, 0.21f, 0.22f}}}},
};

const RenderNamedPalette *render_palette(int32_t index) {
  return index >= 0 && index < (int32_t)(sizeof palettes / sizeof palettes[0]) ? &palettes[index] : NULL;
}
