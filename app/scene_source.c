// A strict reader of JSON text (RFC 8259) that keeps nothing but its position. It says what is wrong and in which line,
// which the tree builder (cJSON) does not, and finds the line of any value afterwards.
#include "app/scene_source.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "app/text.h"

typedef struct Scan {
  const char *text;
  size_t size, at;
  int depth, values;
  char cause[160];
} Scan;

static bool scan_value(Scan *scan);

static int line_of(const char *text, size_t at) {
  int line = 1;
  for (size_t i = 0; i < at; i++) line += text[i] == '\n';
  return line;
}

static int peek(const Scan *scan) {
  return scan->at < scan->size ? (unsigned char)scan->text[scan->at] : -1;
}

static bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

static void skip_space(Scan *scan) {
  while (scan->at < scan->size && is_space(scan->text[scan->at])) scan->at++;
}

static bool wrong(Scan *scan, const char *cause) {
  snprintf(scan->cause, sizeof scan->cause, "%s", cause);
  return false;
}

static bool unexpected(Scan *scan, const char *wanted) {
  int c = peek(scan);
  if (c < 0)
    snprintf(scan->cause, sizeof scan->cause, "the text ends where %s should come", wanted);
  else if (c == 0)
    snprintf(scan->cause, sizeof scan->cause, "a NUL byte where %s should come", wanted);
  else if (c == '/' || c == '#')
    snprintf(scan->cause, sizeof scan->cause, "expected %s, got '%c' (JSON has no comments)", wanted, c);
  else if (c < 0x20 || c > 0x7e)
    snprintf(scan->cause, sizeof scan->cause, "expected %s, got byte 0x%02x", wanted, (unsigned)c);
  else
    snprintf(scan->cause, sizeof scan->cause, "expected %s, got '%c'", wanted, c);
  return false;
}

// ---- Strings, numbers, words ----------------------------------------------------------------------------------------

/// Four hexadecimal digits; −1 when they are not.
static int scan_hex(Scan *scan) {
  int code = 0;
  for (int i = 0; i < 4; i++, scan->at++) {
    int c = peek(scan);
    int digit = c >= '0' && c <= '9'   ? c - '0'
                : c >= 'a' && c <= 'f' ? c - 'a' + 10
                : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                       : -1;
    if (digit < 0) return -1;
    code = 16 * code + digit;
  }
  return code;
}

static bool scan_escape(Scan *scan) {
  scan->at++; // the backslash
  int c = peek(scan);
  if (c <= 0 || !strchr("\"\\/bfnrtu", c)) return wrong(scan, "an invalid escape in a string");
  scan->at++;
  if (c != 'u') return true;
  int code = scan_hex(scan);
  if (code == 0) return wrong(scan, "a NUL character in a string");
  if (code >= 0xd800 && code < 0xdc00 && peek(scan) == '\\') {
    scan->at++;
    if (peek(scan) != 'u') return wrong(scan, "an invalid \\u escape in a string");
    scan->at++;
    int low = scan_hex(scan);
    return (low >= 0xdc00 && low < 0xe000) || wrong(scan, "an invalid \\u escape in a string");
  }
  return (code > 0 && (code < 0xd800 || code >= 0xe000)) || wrong(scan, "an invalid \\u escape in a string");
}

static bool scan_string(Scan *scan) {
  size_t start = scan->at++;
  for (int c; (c = peek(scan)) != '"';) {
    if (c < 0) {
      snprintf(scan->cause, sizeof scan->cause, "the text ends inside a string that begins in line %d",
               line_of(scan->text, start));
      return false;
    }
    if (c == '\n' || c == '\r') return wrong(scan, "a string is not closed");
    if (c == 0) return wrong(scan, "a NUL byte in a string");
    if (c < 0x20) return wrong(scan, "a control character in a string");
    if (c == '\\') {
      if (!scan_escape(scan)) return false;
      continue;
    }
    size_t length = text_utf8_length(scan->text + scan->at, scan->size - scan->at);
    if (length == 0) return wrong(scan, "a string that is not UTF-8");
    scan->at += length;
  }
  scan->at++;
  return true;
}

static bool scan_digits(Scan *scan) {
  size_t start = scan->at;
  while (peek(scan) >= '0' && peek(scan) <= '9') scan->at++;
  return scan->at > start || unexpected(scan, "a digit");
}

static bool scan_number(Scan *scan) {
  size_t start = scan->at;
  if (peek(scan) == '-') scan->at++;
  bool zero = peek(scan) == '0';
  if (!scan_digits(scan)) return false;
  if (zero && scan->at > start + 1 + (scan->text[start] == '-')) return wrong(scan, "a number with a leading zero");
  if (peek(scan) == '.') {
    scan->at++;
    if (!scan_digits(scan)) return false;
  }
  if (peek(scan) == 'e' || peek(scan) == 'E') {
    scan->at++;
    if (peek(scan) == '+' || peek(scan) == '-') scan->at++;
    if (!scan_digits(scan)) return false;
  }
  // The tree builder reads no longer ones whole.
  return scan->at - start <= 60 || wrong(scan, "a number with more than 60 characters");
}

static bool scan_word(Scan *scan, const char *word) {
  size_t length = strlen(word);
  if (scan->size - scan->at < length || memcmp(scan->text + scan->at, word, length) != 0)
    return unexpected(scan, "a value (a number, a string in \"\", true, false, null, [ or {)");
  scan->at += length;
  return true;
}

// ---- Objects and lists ----------------------------------------------------------------------------------------------

/// Behind a member or item: true at the end of the list; otherwise after its comma, or with a cause.
static bool scan_next(Scan *scan, char close, size_t start, bool *done) {
  skip_space(scan);
  int c = peek(scan);
  *done = c == close;
  if (*done || c == ',') {
    scan->at++;
    return true;
  }
  if (c < 0) {
    snprintf(scan->cause, sizeof scan->cause, "the text ends inside %s that begins in line %d",
             close == '}' ? "an object" : "a list", line_of(scan->text, start));
    return false;
  }
  return unexpected(scan, close == '}' ? "',' or '}'" : "',' or ']'");
}

/// A key and its colon.
static bool scan_key(Scan *scan) {
  skip_space(scan);
  if (peek(scan) != '"') return unexpected(scan, "a key in \"\"");
  if (!scan_string(scan)) return false;
  skip_space(scan);
  if (peek(scan) != ':') return unexpected(scan, "':'");
  scan->at++;
  return true;
}

static bool scan_members(Scan *scan, char close) {
  size_t start = scan->at++;
  skip_space(scan);
  if (peek(scan) == close) {
    scan->at++;
    return true;
  }
  for (bool done = false; !done;) {
    if (close == '}' && !scan_key(scan)) return false;
    if (!scan_value(scan) || !scan_next(scan, close, start, &done)) return false;
  }
  return true;
}

static bool scan_value(Scan *scan) {
  skip_space(scan);
  if (++scan->values > SCENE_MOST_VALUES) {
    snprintf(scan->cause, sizeof scan->cause, "more than %d values", SCENE_MOST_VALUES);
    return false;
  }
  int c = peek(scan);
  if (c == '"') return scan_string(scan);
  if (c == '-' || (c >= '0' && c <= '9')) return scan_number(scan);
  if (c != '{' && c != '[') return scan_word(scan, c == 't' ? "true" : c == 'f' ? "false" : "null");
  if (++scan->depth > SCENE_MOST_LEVELS) {
    snprintf(scan->cause, sizeof scan->cause, "nested deeper than %d levels", SCENE_MOST_LEVELS);
    return false;
  }
  bool good = scan_members(scan, c == '{' ? '}' : ']');
  scan->depth--;
  return good;
}

static bool scan_text(Scan *scan) {
  if (!scan_value(scan)) return false;
  skip_space(scan);
  return scan->at == scan->size || unexpected(scan, "the end of the text");
}

bool scene_is_json(const char *text, size_t size) {
  Scan scan = {.text = text, .size = size};
  return scan_text(&scan);
}

bool scene_check_syntax(const SceneSource *source) {
  Scan scan = {.text = source->text, .size = source->size};
  skip_space(&scan);
  if (scan.at == scan.size) return app_fail(source->error, APP_BAD_INPUT, "%s: the file is empty", source->name);
  if (scan_text(&scan)) return true;
  // Where the text ends too early, its last line is the last with something in it.
  size_t at = scan.at;
  while (scan.at == source->size && at > 0 && is_space(source->text[at - 1])) at--;
  return app_fail(source->error, APP_BAD_INPUT, "%s:%d: not valid JSON: %s", source->name, line_of(source->text, at),
                  scan.cause);
}

// ---- Lines ----------------------------------------------------------------------------------------------------------

/// Go on to member or item number `ordinal` of the value at hand; false when there is none.
static bool enter(Scan *scan, int ordinal, size_t *place) {
  skip_space(scan);
  int open = peek(scan);
  if (ordinal < 0 || (open != '{' && open != '[')) return false;
  size_t start = scan->at++;
  skip_space(scan);
  bool done = peek(scan) == (open == '{' ? '}' : ']');
  for (int i = 0; !done; i++) {
    skip_space(scan);
    *place = scan->at;
    if (open == '{' && !scan_key(scan)) return false;
    if (i == ordinal) return true;
    if (!scan_value(scan) || !scan_next(scan, open == '{' ? '}' : ']', start, &done)) return false;
  }
  return false;
}

static bool follow(Scan *scan, const ScenePath *path, size_t *place) {
  if (!path->parent) {
    skip_space(scan);
    *place = scan->at;
    return true;
  }
  size_t here = 0;
  if (!follow(scan, path->parent, place) || !enter(scan, path->ordinal, &here)) return false;
  *place = here;
  return true;
}

int scene_locate(const char *text, size_t size, const ScenePath *path) {
  Scan scan = {.text = text, .size = size};
  size_t place = 0;
  follow(&scan, path, &place);
  return line_of(text, place);
}

// ---- Messages -------------------------------------------------------------------------------------------------------

char *scene_path_print(const ScenePath *path, char *text, size_t size) {
  if (!path->parent) {
    *text = 0;
    return text;
  }
  scene_path_print(path->parent, text, size);
  size_t used = strlen(text);
  char part[80];
  if (path->key)
    text_printable(part, sizeof part, path->key, 40);
  else
    snprintf(part, sizeof part, "%d", path->ordinal);
  snprintf(text + used, size - used, "%s%s", used ? "." : "", part);
  return text;
}

/// Whether the key path of a --set is `path`, lies in it, or holds it.
static bool set_concerns(const char *set, const char *path) {
  size_t set_length = strcspn(set, "="), path_length = strlen(path);
  size_t shorter = set_length < path_length ? set_length : path_length;
  if (shorter == 0 || memcmp(set, path, shorter) != 0) return false;
  if (set_length == path_length) return true;
  return set_length > path_length ? set[path_length] == '.' : path[set_length] == '.';
}

bool scene_fail(const SceneSource *source, const ScenePath *path, const char *format, ...) {
  char message[512], keys[SCENE_PATH_SIZE], place[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  scene_path_print(path, keys, sizeof keys);

  // The last --set wins, so it is to blame first.
  int set = source->set_count - 1;
  while (set >= 0 && !set_concerns(source->sets[set], keys)) set--;
  if (set >= 0) {
    char printable[200];
    snprintf(place, sizeof place, "--set %s", text_printable(printable, sizeof printable, source->sets[set], 100));
  } else {
    snprintf(place, sizeof place, "%s:%d", source->name, scene_locate(source->text, source->size, path));
  }
  return app_fail(source->error, APP_BAD_INPUT, "%s: %s%s%s", place, keys, *keys ? ": " : "", message);
}
