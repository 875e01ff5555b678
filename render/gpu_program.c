// Programs from the shader files that CMake has put into the library.
//
// Includes are resolved here. Line n of file f is called line f·LINES_PER_FILE + n by #line directives, so that the
// compiler's "0:20017: error" can be turned back into "water.glsl:17: error". (GLSL's own source-string numbers would be
// the natural way, but Mesa reports them wrongly after an included file.)
#include "render/gpu.h"

#include <ctype.h>
#include <epoxy/gl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_FILES 32 // files that make up one program
#define MAX_DEPTH 8  // of includes within includes
#define LINES_PER_FILE 10000

// The source of one stage as it grows, and the files that it came from: files[i] has the lines from i·LINES_PER_FILE.
typedef struct Assembly {
  const GpuSource *sources;
  char *text;
  size_t length, capacity;
  const char *files[MAX_FILES];
  int file_count;
  bool out_of_memory;
} Assembly;

// ---- Putting the text together ---------------------------------------------------------------------------------------

static void append(Assembly *a, const char *text, size_t length) {
  if (a->length + length + 1 > a->capacity) {
    const size_t capacity = 2 * (a->length + length + 1);
    char *grown = realloc(a->text, capacity);
    if (grown == NULL) {
      a->out_of_memory = true;
      return;
    }
    a->text = grown;
    a->capacity = capacity;
  }
  memcpy(a->text + a->length, text, length);
  a->length += length;
  a->text[a->length] = '\0';
}

static void append_line_directive(Assembly *a, int line, int file) {
  char directive[48];
  const int length = snprintf(directive, sizeof directive, "#line %d\n", file * LINES_PER_FILE + line);
  append(a, directive, (size_t)length);
}

static const GpuSource *find_source(const GpuSource *sources, const char *name, size_t length) {
  for (; sources->name != NULL; ++sources) {
    if (strlen(sources->name) == length && memcmp(sources->name, name, length) == 0) return sources;
  }
  return NULL;
}

// Is `line` an #include? Then *name and *length are what stands between the quotes.
static bool parse_include(const char *line, const char *end, const char **name, size_t *length) {
  while (line < end && isspace((unsigned char)*line)) ++line;
  if ((size_t)(end - line) < 8 || strncmp(line, "#include", 8) != 0) return false;
  const char *open = memchr(line, '"', (size_t)(end - line));
  const char *close = open != NULL ? memchr(open + 1, '"', (size_t)(end - open - 1)) : NULL;
  *name = close != NULL ? open + 1 : line;
  *length = close != NULL ? (size_t)(close - open - 1) : 0;
  return true;
}

static bool append_file(Assembly *a, const char *name, size_t name_length, int depth, RenderError *error);

// Copy a file line by line; an #include is replaced by the file it names.
static bool append_lines(Assembly *a, const char *text, int file, int depth, RenderError *error) {
  append_line_directive(a, 1, file);
  int number = 1;
  for (const char *line = text; *line != '\0'; ++number) {
    const char *newline = strchr(line, '\n');
    const char *end = newline != NULL ? newline : line + strlen(line);
    const char *include;
    size_t length;
    if (parse_include(line, end, &include, &length)) {
      if (find_source(a->sources, include, length) == NULL) {
        return gpu_fail(error, "%s:%d: there is no shader file \"%.*s\" to include", a->files[file], number,
                        (int)length, include);
      }
      if (!append_file(a, include, length, depth + 1, error)) return false;
      append_line_directive(a, number + 1, file);
    } else {
      append(a, line, (size_t)(end - line));
      append(a, "\n", 1);
    }
    line = newline != NULL ? newline + 1 : end;
  }
  return true;
}

static bool append_file(Assembly *a, const char *name, size_t name_length, int depth, RenderError *error) {
  // A file is taken once per stage, as if it had an include guard.
  for (int i = 0; i < a->file_count; ++i) {
    if (strlen(a->files[i]) == name_length && memcmp(a->files[i], name, name_length) == 0) return true;
  }
  if (depth > MAX_DEPTH || a->file_count == MAX_FILES) {
    return gpu_fail(error, "%.*s: too many shader files included", (int)name_length, name);
  }
  const GpuSource *source = find_source(a->sources, name, name_length);
  if (source == NULL) return gpu_fail(error, "there is no shader file \"%.*s\"", (int)name_length, name);
  const int file = a->file_count++;
  a->files[file] = source->name;
  return append_lines(a, source->text, file, depth, error);
}

static bool assemble(Assembly *a, const GpuProgramDesc *desc, const char *stage_define, RenderError *error) {
  *a = (Assembly){.sources = desc->sources != NULL ? desc->sources : gpu_sources};
  const char *version = "#version 450 core\n";
  append(a, version, strlen(version));
  append(a, stage_define, strlen(stage_define));
  if (desc->defines != NULL) append(a, desc->defines, strlen(desc->defines));
  if (!append_file(a, desc->file, strlen(desc->file), 0, error)) return false;
  if (a->out_of_memory) return gpu_fail(error, "out of memory for shader \"%s\"", desc->file);
  return true;
}

// ---- Compiling -------------------------------------------------------------------------------------------------------

// A compiler's first complaint begins "0:12(5): error: …" (Mesa), "0(12) : error …" (NVIDIA) or "ERROR: 0:12: …"
// (AMD, Intel): a number that says nothing, the line, the text.
static bool fail_with_log(const Assembly *a, const GpuProgramDesc *desc, const char *log, RenderError *error) {
  const char *place = log;
  while (*place != '\0' && !isdigit((unsigned char)*place)) ++place;
  int line = 0, length = 0;
  const int found = sscanf(place, "%*d%*1[:(]%d%n", &line, &length);
  const int file = line / LINES_PER_FILE;
  if (found < 1 || line < 0 || file >= a->file_count) {
    return gpu_fail(error, "shader \"%s\" (%s): %s", desc->label, desc->file, log);
  }
  const char *text = place + length;
  text += strspn(text, "():0123456789 ");
  return gpu_fail(error, "%s:%d: %.*s", a->files[file], line % LINES_PER_FILE, (int)strcspn(text, "\n"), text);
}

static bool compile_stage(GLuint program, GLenum stage, const char *stage_define, const GpuProgramDesc *desc,
                          RenderError *error) {
  Assembly a;
  bool compiled = assemble(&a, desc, stage_define, error);
  if (compiled) {
    const GLuint shader = glCreateShader(stage);
    const GLchar *text = a.text;
    glObjectLabel(GL_SHADER, shader, -1, desc->label);
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    GLint ok = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok) {
      glAttachShader(program, shader);
    } else {
      char log[2048] = "";
      glGetShaderInfoLog(shader, sizeof log, NULL, log);
      compiled = fail_with_log(&a, desc, log, error);
    }
    glDeleteShader(shader); // lives on while the program has it
  }
  free(a.text);
  return compiled;
}

static bool compile_stages(GLuint program, const GpuProgramDesc *desc, RenderError *error) {
  if (desc->compute) return compile_stage(program, GL_COMPUTE_SHADER, "#define COMPUTE_STAGE 1\n", desc, error);
  return compile_stage(program, GL_VERTEX_SHADER, "#define VERTEX_STAGE 1\n", desc, error) &&
         compile_stage(program, GL_FRAGMENT_SHADER, "#define FRAGMENT_STAGE 1\n", desc, error);
}

static bool link_program(GLuint program, const GpuProgramDesc *desc, RenderError *error) {
  glLinkProgram(program);
  GLint ok = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok) return true;
  char log[2048] = "";
  glGetProgramInfoLog(program, sizeof log, NULL, log);
  return gpu_fail(error, "shader \"%s\" (%s) does not link: %s", desc->label, desc->file, log);
}

// FNV-1a over file and defines; never 0.
static uint64_t program_identity(const GpuProgramDesc *desc) {
  const char *parts[2] = {desc->file, desc->defines != NULL ? desc->defines : ""};
  uint64_t hash = 14695981039346656037u;
  for (int i = 0; i < 2; ++i) {
    for (const char *c = parts[i]; *c != '\0'; ++c) hash = (hash ^ (unsigned char)*c) * 1099511628211u;
    hash = (hash ^ 0xffu) * 1099511628211u;
  }
  return hash != 0 ? hash : 1;
}

bool gpu_program_prepare(GpuProgram *program, const GpuProgramDesc *desc, RenderError *error) {
  const uint64_t identity = program_identity(desc);
  if (program->id != 0 && program->identity == identity) return true;
  const GLuint id = glCreateProgram();
  glObjectLabel(GL_PROGRAM, id, -1, desc->label);
  if (!compile_stages(id, desc, error) || !link_program(id, desc, error)) {
    glDeleteProgram(id);
    return false;
  }
  gpu_program_destroy(program);
  *program = (GpuProgram){id, identity};
  return true;
}

void gpu_program_destroy(GpuProgram *program) {
  if (program->id != 0) glDeleteProgram(program->id);
  *program = (GpuProgram){0};
}
