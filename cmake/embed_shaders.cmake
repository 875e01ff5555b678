# Write the shader files into one C file: cmake -DOUTPUT=… -DSHADERS=a.glsl;b.glsl -P embed_shaders.cmake
# The bytes are written as numbers, since ISO C limits the length of a string literal.
set(arrays "")
set(rows "")
foreach(path IN LISTS SHADERS)
  get_filename_component(name ${path} NAME)
  string(MAKE_C_IDENTIFIER ${name} identifier)
  file(READ ${path} bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(REPLACE "0x0a," "0x0a,\n" bytes "${bytes}")
  string(APPEND arrays "static const unsigned char ${identifier}[] = {\n${bytes}0};\n")
  string(APPEND rows "  {\"${name}\", (const char *)${identifier}},\n")
endforeach()
file(WRITE ${OUTPUT} "// Generated from render/shaders/*.glsl.\n#include \"render/gpu.h\"\n\n${arrays}\nconst GpuSource gpu_sources[] = {\n${rows}  {0}};\n")
