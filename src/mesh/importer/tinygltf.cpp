#include <fstream>  // of writers in the header, which does not include it without file access

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
