// What --vary says, "KEY=a,b,c": the values that a key of the scene takes in turn. Several of them make combinations, in
// which the last key changes first. Commas in brackets and in strings are part of a value, so that vectors stay whole.
#ifndef LIDO_APP_VARY_H
#define LIDO_APP_VARY_H

#include <stdbool.h>
#include <stddef.h>

enum { VARY_MOST_KEYS = 8, VARY_MOST_COMBINATIONS = 64 };

/// Whether it has the right form and a key that changes nothing but the picture. false and *cause.
bool vary_check(const char *vary, char *cause, size_t size);

/// Bytes of the key, at the start of `vary`.
size_t vary_key_length(const char *vary);
/// How many values it has, 1 or more.
int vary_value_count(const char *vary);
/// The value at this place, *length bytes of `vary`; NULL: there are fewer.
const char *vary_value(const char *vary, int place, size_t *length);
/// "KEY=VALUE" with the value at this place, to be freed; NULL when memory runs out.
char *vary_set(const char *vary, int place);

/// Whether both vary the same key.
bool vary_same_key(const char *a, const char *b);
/// How many combinations `varies` (count) make, VARY_MOST_COMBINATIONS + 1: more than there may be.
int vary_combination_count(const char *const *varies, int count);
/// The place of the value that varies[k] has in a combination.
int vary_place(const char *const *varies, int count, int k, int combination);

#endif
