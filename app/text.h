// Text that grows: for everything the program prints that has no fixed length.
#ifndef LIDO_APP_TEXT_H
#define LIDO_APP_TEXT_H

#include <stdbool.h>
#include <stddef.h>

/// Start with all zero. `failed` stays true once memory has run out; nothing is added from then on.
typedef struct Text {
  char *data;
  size_t size, capacity;
  bool failed;
} Text;

void text_add(Text *text, const char *string);
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void text_format(Text *text, const char *format, ...);

/// A JSON string in quotes.
void text_add_json_string(Text *text, const char *string);
/// The shortest decimal that reads back as the same number; null for NaN.
void text_add_float(Text *text, float value);
void text_add_double(Text *text, double value);

/// The finished text, to be freed by the caller; NULL when memory ran out.
char *text_take(Text *text);

/// Copy `from` so that it is fit for a one-line message: cut to `limit` bytes between characters, control characters
/// (also those of UTF-8 and bytes that are not UTF-8) replaced by '?'. Returns `to`, which holds `size` bytes.
char *text_printable(char *to, size_t size, const char *from, size_t limit);

/// Length of the valid UTF-8 character at `bytes`, 0 when there is none.
size_t text_utf8_length(const char *bytes, size_t size);

/// The name among `names` (count) that is nearest to `name` by edit distance (Damerau 1964, adjacent letters may be
/// swapped), near enough to be meant; NULL when there is none.
const char *text_nearest(const char *name, const char *const *names, int count);

#endif
