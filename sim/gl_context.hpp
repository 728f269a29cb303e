// Private to sim: one off-screen OpenGL 3.3 core context of OSMesa, owned and used by the thread that makes it. Every
// GL entry point comes from OSMesaGetProcAddress; no libGL is linked, no display and no GPU are touched.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <thread>

#ifndef GL_GLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES  // declarations only serve as types here
#endif
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>

namespace binpick {

#define BINPICK_GL_FUNCTIONS(X)                                                                                        \
  X(AttachShader)                                                                                                      \
  X(BindBuffer) X(BindFramebuffer) X(BindRenderbuffer) X(BindVertexArray) X(BufferData) X(CheckFramebufferStatus)      \
      X(ClearBufferfv) X(ClearBufferiv) X(CompileShader) X(CreateProgram) X(CreateShader) X(CullFace) X(DeleteBuffers) \
          X(DeleteFramebuffers) X(DeleteRenderbuffers) X(DeleteShader) X(DeleteVertexArrays) X(DepthFunc) X(Disable)   \
              X(DrawBuffers) X(DrawElements) X(Enable) X(EnableVertexAttribArray) X(FramebufferRenderbuffer)           \
                  X(FrontFace) X(GenBuffers) X(GenFramebuffers) X(GenRenderbuffers) X(GenVertexArrays) X(GetError)     \
                      X(GetProgramInfoLog) X(GetProgramiv) X(GetShaderInfoLog) X(GetShaderiv) X(GetString)             \
                          X(GetUniformLocation) X(LinkProgram) X(PixelStorei) X(ReadBuffer) X(ReadPixels)              \
                              X(RenderbufferStorage) X(Scissor) X(ShaderSource) X(Uniform1i) X(Uniform2f)              \
                                  X(UniformMatrix4fv) X(UseProgram) X(VertexAttribPointer) X(Viewport)

/// The entry points that the renderer uses, without their gl prefix.
struct GlFunctions {
#define BINPICK_GL_MEMBER(name) decltype(&::gl##name) name = nullptr;
  BINPICK_GL_FUNCTIONS(BINPICK_GL_MEMBER)
#undef BINPICK_GL_MEMBER
};

class GlContext {
 public:
  GlContext();  ///< throws std::runtime_error
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Makes this context the thread's current one and hands out its functions.
  const GlFunctions& use();
  /// Compiles and links; throws std::runtime_error with the compiler's words.
  GLuint make_program(const char* vertex_source, const char* fragment_source);
  /// Throws std::runtime_error if GL reported an error since the last call.
  void check(const char* where);
  std::string description();

 private:
  GLuint compile(GLenum stage, const char* source);

  OSMesaContext context_ = nullptr;
  std::thread::id owner_ = std::this_thread::get_id();
  std::array<std::uint8_t, 4 * 16 * 16> window_{};  // OSMesa wants one; everything is drawn into framebuffer objects
  GlFunctions gl_;
};

}  // namespace binpick
