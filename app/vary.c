#include "app/vary.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Bytes of the value that `text` begins with: up to a comma that is in no bracket and no string.
static size_t value_length(const char *text) {
  int depth = 0;
  bool quoted = false;
  const char *c = text;
  for (; *c && (quoted || depth > 0 || *c != ','); c++) {
    if (quoted && *c == '\\' && c[1])
      c++;
    else if (*c == '"')
      quoted = !quoted;
    else if (!quoted && strchr("[{", *c))
      depth++;
    else if (!quoted && strchr("]}", *c) && depth > 0)
      depth--;
  }
  return (size_t)(c - text);
}

static bool changes_picture_only(const char *key) {
  static const char *const parts[] = {"render.", "light.", "environment.", "camera."};
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
    if (strncmp(key, parts[i], strlen(parts[i])) == 0) return true;
  return false;
}

bool vary_check(const char *vary, char *cause, size_t size) {
  size_t length = vary_key_length(vary);
  bool good = length > 0 && vary[length] == '=';
  for (int i = 0; good && vary_value(vary, i, &length); i++) good = length > 0;
  if (!good) {
    snprintf(cause, size, "must have the form key.path=value,value,... and no value may be empty");
    return false;
  }
  if (changes_picture_only(vary)) return true;
  snprintf(cause, size,
           "only keys that change nothing but the picture can vary, those of render, light, environment "
           "and camera");
  return false;
}

size_t vary_key_length(const char *vary) {
  return strcspn(vary, "=");
}

int vary_value_count(const char *vary) {
  size_t length;
  int count = 1;
  while (vary_value(vary, count, &length)) count++;
  return count;
}

const char *vary_value(const char *vary, int place, size_t *length) {
  const char *value = vary + vary_key_length(vary) + 1;
  for (*length = value_length(value); place > 0; place--) {
    value += *length;
    if (!*value++) return NULL;
    *length = value_length(value);
  }
  return value;
}

char *vary_set(const char *vary, int place) {
  size_t key = vary_key_length(vary) + 1, length;
  const char *value = vary_value(vary, place, &length);
  char *set = malloc(key + length + 1);
  if (!set) return NULL;
  memcpy(set, vary, key);
  memcpy(set + key, value, length);
  set[key + length] = 0;
  return set;
}

bool vary_same_key(const char *a, const char *b) {
  size_t length = vary_key_length(a);
  return length == vary_key_length(b) && strncmp(a, b, length) == 0;
}

int vary_combination_count(const char *const *varies, int count) {
  int combinations = 1;
  for (int k = 0; k < count; k++) {
    int values = vary_value_count(varies[k]);
    if (values > VARY_MOST_COMBINATIONS / combinations) return VARY_MOST_COMBINATIONS + 1;
    combinations *= values;
  }
  return combinations;
}

int vary_place(const char *const *varies, int count, int k, int combination) {
  for (int last = count - 1; last > k; last--) combination /= vary_value_count(varies[last]);
  return combination % vary_value_count(varies[k]);
}
