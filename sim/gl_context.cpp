#include "sim/gl_context.hpp"

#include <stdexcept>

#include "core/check.hpp"

namespace binpick {

GlContext::GlContext() {
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            0};
  context_ = OSMesaCreateContextAttribs(attributes, nullptr);
  if (context_ == nullptr) throw std::runtime_error("OSMesa gives no OpenGL 3.3 core context");
  try {
    if (OSMesaMakeCurrent(context_, window_.data(), GL_UNSIGNED_BYTE, 16, 16) != GL_TRUE)
      throw std::runtime_error("OSMesa cannot make its context current");
#define BINPICK_GL_LOAD(name)                                                           \
  gl_.name = reinterpret_cast<decltype(&::gl##name)>(OSMesaGetProcAddress("gl" #name)); \
  if (gl_.name == nullptr) throw std::runtime_error("OSMesa lacks gl" #name);
    BINPICK_GL_FUNCTIONS(BINPICK_GL_LOAD)
#undef BINPICK_GL_LOAD
  } catch (...) {
    OSMesaDestroyContext(context_);
    throw;
  }
}

GlContext::~GlContext() { OSMesaDestroyContext(context_); }

const GlFunctions& GlContext::use() {
  BP_CHECK(std::this_thread::get_id() == owner_, "a GL context belongs to the thread that made it");
  if (OSMesaGetCurrentContext() != context_ &&
      OSMesaMakeCurrent(context_, window_.data(), GL_UNSIGNED_BYTE, 16, 16) != GL_TRUE)
    throw std::runtime_error("OSMesa cannot make its context current");
  return gl_;
}

GLuint GlContext::compile(GLenum stage, const char* source) {
  const GLuint shader = gl_.CreateShader(stage);
  gl_.ShaderSource(shader, 1, &source, nullptr);
  gl_.CompileShader(shader);
  GLint good = 0;
  gl_.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good == GL_TRUE) return shader;
  char log[1000] = "";
  gl_.GetShaderInfoLog(shader, sizeof(log), nullptr, log);
  throw std::runtime_error(std::string("shader does not compile: ") + log);
}

GLuint GlContext::make_program(const char* vertex_source, const char* fragment_source) {
  use();
  const GLuint program = gl_.CreateProgram();
  for (const GLuint shader : {compile(GL_VERTEX_SHADER, vertex_source), compile(GL_FRAGMENT_SHADER, fragment_source)}) {
    gl_.AttachShader(program, shader);
    gl_.DeleteShader(shader);  // lives as long as the program
  }
  gl_.LinkProgram(program);
  GLint good = 0;
  gl_.GetProgramiv(program, GL_LINK_STATUS, &good);
  if (good == GL_TRUE) return program;
  char log[1000] = "";
  gl_.GetProgramInfoLog(program, sizeof(log), nullptr, log);
  throw std::runtime_error(std::string("shaders do not link: ") + log);
}

void GlContext::check(const char* where) {
  const GLenum error = gl_.GetError();
  if (error != GL_NO_ERROR) throw std::runtime_error(std::string(where) + ": OpenGL error " + std::to_string(error));
}

std::string GlContext::description() {
  use();
  const auto text = [&](GLenum name) { return std::string(reinterpret_cast<const char*>(gl_.GetString(name))); };
  return "OSMesa, " + text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

}  // namespace binpick
