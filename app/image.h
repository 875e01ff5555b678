// Pictures: PNG (8 bits, RGB) and PFM (floats, for raw layers), written whole or not at all.
#ifndef LIDO_APP_IMAGE_H
#define LIDO_APP_IMAGE_H

#include <stdint.h>

#include "app/app.h"

enum { IMAGE_MAX_SIZE = 16384 }; ///< pixels, largest width and height

/// An image in memory: rows from top to bottom. Either bytes (PNG) or values (PFM) is set.
typedef struct Image {
  int32_t width, height, channels; ///< PNG: 3; PFM: 1 or 3
  uint8_t *bytes;                  ///< (height, width, 3)
  float *values;                   ///< (height, width, channels)
} Image;
void image_free(Image *image);

/// Write a PNG from width·height·3 bytes, or a PFM from width·height·channels floats (channels 1 or 3).
bool image_write_png(const char *path, const uint8_t *rgb, int32_t width, int32_t height, AppError *error);
bool image_write_pfm(const char *path, const float *values, int32_t width, int32_t height, int32_t channels,
                     AppError *error);

/// Read one. Transparency is dropped, other depths become 8 bits. False and *error (APP_BAD_INPUT) for what is none.
bool image_read_png(const char *path, Image *image, AppError *error);
bool image_read_pfm(const char *path, Image *image, AppError *error);

#endif
