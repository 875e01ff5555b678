#include "app/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool make_room(Text *text, size_t more) {
  if (text->failed) return false;
  if (text->size + more + 1 <= text->capacity) return true;
  size_t capacity = 2 * text->capacity + more + 256;
  char *data = realloc(text->data, capacity);
  if (!data) {
    text->failed = true;
    return false;
  }
  text->data = data;
  text->capacity = capacity;
  return true;
}

static void add_bytes(Text *text, const char *bytes, size_t count) {
  if (!make_room(text, count)) return;
  memcpy(text->data + text->size, bytes, count);
  text->size += count;
  text->data[text->size] = 0;
}

void text_add(Text *text, const char *string) {
  add_bytes(text, string, strlen(string));
}

void text_format(Text *text, const char *format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  int length = vsnprintf(NULL, 0, format, arguments);
  if (length >= 0 && make_room(text, (size_t)length)) {
    vsnprintf(text->data + text->size, (size_t)length + 1, format, again);
    text->size += (size_t)length;
  }
  va_end(again);
  va_end(arguments);
}

void text_add_json_string(Text *text, const char *string) {
  text_add(text, "\"");
  for (const char *c = string; *c; c++) {
    if (*c == '"' || *c == '\\')
      text_format(text, "\\%c", *c);
    else if ((unsigned char)*c < 0x20)
      text_format(text, "\\u%04x", (unsigned)*c);
    else
      add_bytes(text, c, 1);
  }
  text_add(text, "\"");
}

void text_add_double(Text *text, double value) {
  if (isnan(value)) {
    text_add(text, "null");
    return;
  }
  char digits[40];
  for (int precision = 6; precision <= 17; precision++) {
    snprintf(digits, sizeof digits, "%.*g", precision, value);
    if (strtod(digits, NULL) == value) break;
  }
  text_add(text, digits);
}

void text_add_float(Text *text, float value) {
  if (isnan(value)) {
    text_add(text, "null");
    return;
  }
  char digits[40];
  for (int precision = 6; precision <= 9; precision++) {
    snprintf(digits, sizeof digits, "%.*g", precision, (double)value);
    // A reader goes through double, so this must too.
    if ((float)strtod(digits, NULL) == value) break;
  }
  text_add(text, digits);
}

char *text_take(Text *text) {
  char *data = text->data;
  if (text->failed) {
    free(data);
    data = NULL;
  } else if (!data) {
    data = calloc(1, 1);
  }
  *text = (Text){0};
  return data;
}

size_t text_utf8_length(const char *bytes, size_t size) {
  const unsigned char *b = (const unsigned char *)bytes;
  if (size == 0) return 0;
  if (b[0] < 0x80) return 1;
  size_t length = b[0] >= 0xf0 ? 4 : b[0] >= 0xe0 ? 3 : 2;
  if (b[0] < 0xc2 || b[0] > 0xf4 || size < length) return 0;
  uint32_t code = b[0] & (0xffu >> (length + 1));
  for (size_t i = 1; i < length; i++) {
    if ((b[i] & 0xc0) != 0x80) return 0;
    code = code << 6 | (b[i] & 0x3f);
  }
  // Refused: longer than needed, surrogates, beyond Unicode.
  static const uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
  bool surrogate = code >= 0xd800 && code <= 0xdfff;
  return code < smallest[length] || surrogate || code > 0x10ffff ? 0 : length;
}

char *text_printable(char *to, size_t size, const char *from, size_t limit) {
  size_t out = 0, left = strlen(from);
  while (left > 0) {
    size_t length = text_utf8_length(from, left);
    if (out + (length ? length : 1) > limit || out + (length ? length : 1) + 4 > size) {
      memcpy(to + out, "...", 3);
      out += 3;
      break;
    }
    // U+0080 … U+009F are control characters too: C2 80 … C2 9F.
    const unsigned char *b = (const unsigned char *)from;
    bool control = length == 0 || b[0] < 0x20 || b[0] == 0x7f || (length == 2 && b[0] == 0xc2 && b[1] < 0xa0);
    if (length == 0) length = 1;
    if (control) {
      to[out++] = '?';
    } else {
      memcpy(to + out, from, length);
      out += length;
    }
    from += length;
    left -= length;
  }
  to[out] = 0;
  return to;
}

// ---- The nearest name -----------------------------------------------------------------------------------------------

enum { LONGEST_NAME = 64 };

static int smaller(int a, int b) {
  return a < b ? a : b;
}

/// Number of letters to insert, delete, replace or swap with the next one.
static int edit_distance(const char *a, size_t a_length, const char *b, size_t b_length) {
  int rows[3][LONGEST_NAME + 1];
  int *before = rows[0], *last = rows[1], *row = rows[2];
  for (size_t j = 0; j <= b_length; j++) last[j] = (int)j;
  memcpy(before, last, sizeof rows[0]);
  for (size_t i = 1; i <= a_length; i++) {
    row[0] = (int)i;
    for (size_t j = 1; j <= b_length; j++) {
      row[j] = smaller(last[j - 1] + (a[i - 1] != b[j - 1]), smaller(last[j], row[j - 1]) + 1);
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = smaller(row[j], before[j - 2] + 1);
    }
    int *oldest = before;
    before = last;
    last = row;
    row = oldest;
  }
  return last[b_length];
}

const char *text_nearest(const char *name, const char *const *names, int count) {
  size_t length = strlen(name);
  if (length == 0 || length > LONGEST_NAME) return NULL;
  const char *nearest = NULL;
  // Up to a third of the letters may be wrong, or two in short names.
  int least = (int)(length > 6 ? length / 3 : length > 2 ? 2 : 1) + 1;
  for (int i = 0; i < count; i++) {
    size_t other = strlen(names[i]);
    if (other > LONGEST_NAME) continue;
    int distance = edit_distance(name, length, names[i], other);
    if (distance < least && distance < (int)other) {
      least = distance;
      nearest = names[i];
    }
  }
  return nearest;
}
