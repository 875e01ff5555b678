#include "app/image.h"

#include <errno.h>
#include <math.h>
#include <spng.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/output.h"

void image_free(Image *image) {
  free(image->bytes);
  free(image->values);
  *image = (Image){0};
}

// ---- PNG -----------------------------------------------------------------------------------------------------------------

static int encode(spng_ctx *context, FILE *file, const uint8_t *rgb, int32_t width, int32_t height) {
  struct spng_ihdr header = {
      .width = (uint32_t)width, .height = (uint32_t)height, .bit_depth = 8, .color_type = SPNG_COLOR_TYPE_TRUECOLOR};
  int status = spng_set_png_file(context, file);
  if (!status) status = spng_set_ihdr(context, &header);
  // Level 3 packs rendered water within a tenth of the best, in a third of the time.
  if (!status) status = spng_set_option(context, SPNG_IMG_COMPRESSION_LEVEL, 3);
  size_t size = (size_t)width * (size_t)height * 3;
  if (!status) status = spng_encode_image(context, rgb, size, SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
  return status;
}

bool image_write_png(const char *path, const uint8_t *rgb, int32_t width, int32_t height, AppError *error) {
  OutputFile *output = output_open(path, error);
  if (!output) return false;
  spng_ctx *context = spng_ctx_new(SPNG_CTX_ENCODER);
  int status = context ? encode(context, output_file(output), rgb, width, height) : SPNG_EMEM;
  spng_ctx_free(context);
  // A write error is told best by the file itself.
  if (status && !ferror(output_file(output))) {
    output_abort(output);
    return app_fail(error, APP_FAILED, "%s: cannot be written as PNG: %s", path, spng_strerror(status));
  }
  return output_commit(output, error);
}

static int decode(spng_ctx *context, FILE *file, Image *image) {
  spng_set_image_limits(context, IMAGE_MAX_SIZE, IMAGE_MAX_SIZE);
  spng_set_chunk_limits(context, 1 << 20, 1 << 24);
  int status = spng_set_png_file(context, file);
  struct spng_ihdr header;
  if (!status) status = spng_get_ihdr(context, &header);
  size_t size = 0;
  if (!status) status = spng_decoded_image_size(context, SPNG_FMT_RGB8, &size);
  if (status) return status;
  image->width = (int32_t)header.width;
  image->height = (int32_t)header.height;
  image->channels = 3;
  image->bytes = malloc(size);
  return image->bytes ? spng_decode_image(context, image->bytes, size, SPNG_FMT_RGB8, 0) : SPNG_EMEM;
}

bool image_read_png(const char *path, Image *image, AppError *error) {
  *image = (Image){0};
  FILE *file = fopen(path, "rb");
  if (!file) return app_fail(error, APP_BAD_INPUT, "%s: cannot be read: %s", path, strerror(errno));
  spng_ctx *context = spng_ctx_new(0);
  int status = context ? decode(context, file, image) : SPNG_EMEM;
  spng_ctx_free(context);
  fclose(file);
  if (!status) return true;
  image_free(image);
  return app_fail(error, APP_BAD_INPUT, "%s: cannot be read as PNG: %s", path, spng_strerror(status));
}

// ---- PFM: a text header, then rows of little-endian floats from bottom to top -----------------------------------------------

static void store_little_endian(uint8_t *bytes, float value) {
  uint32_t bits;
  memcpy(&bits, &value, 4);
  for (int i = 0; i < 4; i++) bytes[i] = (uint8_t)(bits >> (8 * i));
}

static float load_float(const uint8_t *bytes, bool little_endian) {
  uint32_t bits = 0;
  for (int i = 0; i < 4; i++) bits |= (uint32_t)bytes[i] << (little_endian ? 8 * i : 24 - 8 * i);
  float value;
  memcpy(&value, &bits, 4);
  return value;
}

bool image_write_pfm(const char *path, const float *values, int32_t width, int32_t height, int32_t channels,
                     AppError *error) {
  if (channels != 1 && channels != 3)
    return app_fail(error, APP_FAILED, "%s: a PFM holds 1 or 3 channels, not %d", path, channels);
  OutputFile *output = output_open(path, error);
  if (!output) return false;
  size_t row_length = (size_t)width * (size_t)channels;
  uint8_t *row = malloc(row_length * 4);
  if (!row) {
    output_abort(output);
    return app_fail(error, APP_FAILED, "%s: out of memory", path);
  }
  fprintf(output_file(output), "%s\n%d %d\n-1.0\n", channels == 3 ? "PF" : "Pf", width, height);
  for (int32_t y = height - 1; y >= 0; y--) {
    for (size_t i = 0; i < row_length; i++) store_little_endian(row + 4 * i, values[(size_t)y * row_length + i]);
    fwrite(row, 4, row_length, output_file(output));
  }
  free(row);
  return output_commit(output, error);
}

// Read the header. Returns NULL or what is wrong with it.
static const char *read_pfm_header(FILE *file, Image *image, bool *little_endian) {
  char kind[3] = "";
  double scale = 0;
  if (fscanf(file, "%2s %6d %6d %32lf", kind, &image->width, &image->height, &scale) != 4) return "no PFM header";
  if (strcmp(kind, "PF") != 0 && strcmp(kind, "Pf") != 0) return "no PFM header";
  if (image->width < 1 || image->height < 1 || image->width > IMAGE_MAX_SIZE || image->height > IMAGE_MAX_SIZE)
    return "width and height must be in [1, 16384]";
  if (!isfinite(scale) || scale == 0) return "the scale must be a number other than 0";
  fgetc(file); // the one white space that ends the header
  image->channels = kind[1] == 'F' ? 3 : 1;
  *little_endian = scale < 0;
  return NULL;
}

// Read the rows, one at a time so that a header that lies costs no memory. Returns NULL or what is wrong.
static const char *read_pfm_rows(FILE *file, Image *image, bool little_endian) {
  size_t row_length = (size_t)image->width * (size_t)image->channels;
  size_t needed = row_length * (size_t)image->height * 4;
  long start = ftell(file);
  if (start < 0 || fseek(file, 0, SEEK_END) != 0) return strerror(errno);
  long end = ftell(file);
  if (end < start || (size_t)(end - start) < needed) return "the file is cut short";
  if (fseek(file, start, SEEK_SET) != 0) return strerror(errno);
  image->values = malloc(needed);
  if (!image->values) return "out of memory";
  for (int32_t y = image->height - 1; y >= 0; y--) {
    float *row = image->values + (size_t)y * row_length;
    if (fread(row, 4, row_length, file) != row_length) return "the file is cut short";
    for (size_t i = 0; i < row_length; i++) row[i] = load_float((const uint8_t *)&row[i], little_endian);
  }
  return NULL;
}

bool image_read_pfm(const char *path, Image *image, AppError *error) {
  *image = (Image){0};
  FILE *file = fopen(path, "rb");
  if (!file) return app_fail(error, APP_BAD_INPUT, "%s: cannot be read: %s", path, strerror(errno));
  bool little_endian = true;
  const char *wrong = read_pfm_header(file, image, &little_endian);
  if (!wrong) wrong = read_pfm_rows(file, image, little_endian);
  fclose(file);
  if (!wrong) return true;
  image_free(image);
  return app_fail(error, APP_BAD_INPUT, "%s: cannot be read as PFM: %s", path, wrong);
}
