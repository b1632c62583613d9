#include "render/raster/gl_api.h"

#include <GL/osmesa.h>
#include <dlfcn.h>

#include "base/check.h"
#include "base/diagnostics.h"

namespace swarf::render {
namespace {

constexpr int kSurfaceSize = 16;  // pixels; never drawn to

void* open_library() {
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}) {
    if (void* handle = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return handle;
  }
  throw InputError("osmesa-missing", {}, "pictures are drawn by OSMesa, and libOSMesa.so.8 cannot be opened",
                   "install it (Debian: apt-get install libosmesa6), or run with --no-render");
}

}  // namespace

struct OsmesaContext::Library {
  decltype(&OSMesaCreateContextAttribs) create = nullptr;
  decltype(&OSMesaDestroyContext) destroy = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaGetProcAddress) function = nullptr;
};

const OsmesaContext::Library& OsmesaContext::library() {
  // Never closed: Mesa's worker threads outlive the last context.
  static const Library kLibrary = [] {
    void* handle = open_library();
    Library loaded;
    loaded.create = reinterpret_cast<decltype(loaded.create)>(dlsym(handle, "OSMesaCreateContextAttribs"));
    loaded.destroy = reinterpret_cast<decltype(loaded.destroy)>(dlsym(handle, "OSMesaDestroyContext"));
    loaded.make_current = reinterpret_cast<decltype(loaded.make_current)>(dlsym(handle, "OSMesaMakeCurrent"));
    loaded.function = reinterpret_cast<decltype(loaded.function)>(dlsym(handle, "OSMesaGetProcAddress"));
    return loaded;
  }();
  if (kLibrary.create == nullptr || kLibrary.destroy == nullptr || kLibrary.make_current == nullptr ||
      kLibrary.function == nullptr) {
    throw InputError("osmesa-missing", {}, "the OSMesa library found is too old (no core contexts)",
                     "install Mesa 11.2 or newer (Debian: apt-get install libosmesa6)");
  }
  return kLibrary;
}

OsmesaContext::OsmesaContext() : surface_(size_t{kSurfaceSize} * kSurfaceSize) {
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            0};
  context_ = library().create(attributes, nullptr);
  if (context_ == nullptr) {
    throw InputError("osmesa-context", {}, "OSMesa cannot make an OpenGL 3.3 core context",
                     "unset GALLIUM_DRIVER and MESA_GL_VERSION_OVERRIDE, or run with --no-render");
  }
  make_current();
  // The types come from the same X-macro as the names, so each cast restores the function's own type.
#define SWARF_GL_LOAD(type, name)                                    \
  gl_.name = reinterpret_cast<type>(library().function("gl" #name)); \
  SWARF_CHECK(gl_.name != nullptr, "OSMesa has no function gl" #name);
  SWARF_GL_FUNCTIONS(SWARF_GL_LOAD)
#undef SWARF_GL_LOAD
}

OsmesaContext::~OsmesaContext() {
  library().destroy(static_cast<OSMesaContext>(context_));
}

void OsmesaContext::make_current() {
  const auto bound = library().make_current(static_cast<OSMesaContext>(context_), surface_.data(),
                                            GL_UNSIGNED_BYTE, kSurfaceSize, kSurfaceSize);
  SWARF_CHECK(bound, "OSMesa cannot bind its context");
}

}  // namespace swarf::render
