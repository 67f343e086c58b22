#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE  // the loader shows it no images
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
