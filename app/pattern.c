#include "app/pattern.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_DIGITS = 18 }; // what fits an int64_t whatever the digits are

// Read what follows a percent sign: "d" or "0Nd". Returns its length and the least number of digits, 0 for anything else.
static size_t read_number(const char *text, int *digits) {
  *digits = 1;
  if (text[0] == 'd') return 1;
  if (text[0] != '0') return 0;
  int width = 0;
  size_t length = 1;
  while (length < 4 && text[length] >= '0' && text[length] <= '9') width = width * 10 + (text[length++] - '0');
  if (width < 1 || width > MAX_DIGITS || text[length] != 'd') return 0;
  *digits = width;
  return length + 1;
}

bool pattern_parse(Pattern *pattern, const char *text, AppError *error) {
  memset(pattern, 0, sizeof *pattern);
  if (text[0] == '\0') return app_fail(error, APP_BAD_INPUT, "an empty file name");
  if (strlen(text) > PATTERN_MAX_LENGTH) return app_fail(error, APP_BAD_INPUT, "%.200s...: the name is too long", text);

  char *out = pattern->before;
  for (const char *c = text; *c; c++) {
    if (*c != '%') {
      *out++ = *c;
      continue;
    }
    if (c[1] == '%') {
      *out++ = *++c;
      continue;
    }
    size_t length = read_number(c + 1, &pattern->digits);
    if (length == 0)
      return app_fail(error, APP_BAD_INPUT, "%s: a name may hold one number, %%d or %%05d, and %%%% for a percent sign",
                      text);
    if (pattern->numbered) return app_fail(error, APP_BAD_INPUT, "%s: only one number may be in a name", text);
    pattern->numbered = true;
    *out = '\0';
    out = pattern->after;
    c += length;
  }
  *out = '\0';
  if (strchr(pattern->after, '/'))
    return app_fail(error, APP_BAD_INPUT, "%s: the number belongs into the file's name, not into its folder", text);
  return true;
}

char *pattern_expand(const Pattern *pattern, int64_t number) {
  size_t size = strlen(pattern->before) + strlen(pattern->after) + 32;
  char *name = malloc(size);
  if (!name) return NULL;
  if (pattern->numbered)
    snprintf(name, size, "%s%0*" PRId64 "%s", pattern->before, pattern->digits, number, pattern->after);
  else
    snprintf(name, size, "%s", pattern->before);
  return name;
}

// The number that makes `name` out of the pattern's file name, −1 when none does.
static int64_t match_name(const Pattern *pattern, const char *prefix, const char *name) {
  size_t prefix_length = strlen(prefix), suffix_length = strlen(pattern->after), length = strlen(name);
  if (length < prefix_length + suffix_length + 1) return -1;
  size_t digits = length - prefix_length - suffix_length;
  if (digits > MAX_DIGITS || digits < (size_t)pattern->digits) return -1;
  if (strncmp(name, prefix, prefix_length) != 0) return -1;
  if (strcmp(name + length - suffix_length, pattern->after) != 0) return -1;
  // More digits than asked for are right only where the number needs them.
  const char *first = name + prefix_length;
  if (digits > (size_t)pattern->digits && first[0] == '0') return -1;
  int64_t number = 0;
  for (size_t i = 0; i < digits; i++) {
    if (first[i] < '0' || first[i] > '9') return -1;
    number = number * 10 + (first[i] - '0');
  }
  return number;
}

static int compare_numbers(const void *a, const void *b) {
  int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
  return (x > y) - (x < y);
}

// Append a number to a growing array. False when memory runs out.
static bool append(int64_t **numbers, int64_t *count, int64_t *capacity, int64_t number) {
  if (*count == *capacity) {
    int64_t larger = *capacity ? *capacity * 2 : 256;
    int64_t *grown = realloc(*numbers, (size_t)larger * sizeof **numbers);
    if (!grown) return false;
    *numbers = grown;
    *capacity = larger;
  }
  (*numbers)[(*count)++] = number;
  return true;
}

int64_t pattern_list(const Pattern *pattern, int64_t **numbers, AppError *error) {
  *numbers = NULL;
  // Split the part before the number into folder and prefix of the file's name.
  const char *slash = strrchr(pattern->before, '/');
  char folder[PATTERN_MAX_LENGTH + 1] = ".";
  if (slash) {
    size_t length = slash == pattern->before ? 1 : (size_t)(slash - pattern->before);
    memcpy(folder, pattern->before, length);
    folder[length] = '\0';
  }
  const char *prefix = slash ? slash + 1 : pattern->before;

  DIR *directory = opendir(folder);
  if (!directory) {
    app_fail(error, APP_BAD_INPUT, "%s: cannot read this folder: %s", folder, strerror(errno));
    return -1;
  }
  int64_t count = 0, capacity = 0;
  for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
    int64_t number = match_name(pattern, prefix, entry->d_name);
    if (number < 0 || append(numbers, &count, &capacity, number)) continue;
    closedir(directory);
    free(*numbers);
    *numbers = NULL;
    app_fail(error, APP_FAILED, "%s: out of memory", folder);
    return -1;
  }
  closedir(directory);
  if (count > 0) qsort(*numbers, (size_t)count, sizeof **numbers, compare_numbers);
  return count;
}
