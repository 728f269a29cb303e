// OSMesa behind the DepthRenderer interface: eye-space z (R32F), ids (R32I) and normals (RGBA32F) in one pass,
// with a 32-bit float depth buffer. Eye z is interpolated by the rasteriser, so nothing is linearised afterwards.

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/check.hpp"
#include "sim/depth_renderer.hpp"
#include "sim/gl_context.hpp"
#include "sim/gl_mesh_cache.hpp"
#include "sim/picture.hpp"

namespace binpick {
namespace {

// GL samples pixel (u, v) at window (u + 1/2, v + 1/2); PinholeCamera has its centre at (u, v). Image row v is GL row
// v, so the picture is upside down for GL and needs no flip on reading.
constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec3 p_O;
uniform mat4 X_CO;
uniform vec2 scale;    // 2 f / size
uniform vec2 shift;    // 2 (c + 1/2) / size - 1
uniform vec2 depth;    // (far + near) / (far - near), -2 far near / (far - near)
out vec3 p_C;
void main() {
  p_C = (X_CO * vec4(p_O, 1.0)).xyz;
  gl_Position = vec4(scale * p_C.xy + shift * p_C.z, depth.x * p_C.z + depth.y, p_C.z);
}
)";

constexpr const char* kFragmentShader = R"(#version 330 core
in vec3 p_C;
uniform mat3 R_CO;
uniform samplerBuffer normals_O;
uniform int id;
layout(location = 0) out float seen_z;
layout(location = 1) out int seen_id;
layout(location = 2) out vec4 seen_normal;
void main() {
  vec3 n_C = R_CO * texelFetch(normals_O, gl_PrimitiveID).xyz;
  if (dot(n_C, p_C) > 0.0) n_C = -n_C;
  seen_z = p_C.z;
  seen_id = id;
  seen_normal = vec4(n_C, 0.0);
}
)";

constexpr int kTargets = 3;

// The framebuffer: grows to the largest image asked for; smaller images use its corner. It dies with the context, so
// that a renderer may be destroyed by another thread than its own.
class FrameTarget {
 public:
  explicit FrameTarget(GlContext& context) : context_(context) {}
  FrameTarget(const FrameTarget&) = delete;
  FrameTarget& operator=(const FrameTarget&) = delete;

  void bind(int width, int height) {
    if (width > width_ || height > height_) make(std::max(width, width_), std::max(height, height_));
    const GlFunctions& gl = context_.use();
    gl.BindFramebuffer(GL_FRAMEBUFFER, frame_);
    gl.Viewport(0, 0, width, height);
    gl.Enable(GL_SCISSOR_TEST);
    gl.Scissor(0, 0, width, height);
  }

 private:
  void make(int width, int height) {
    free();
    const GlFunctions& gl = context_.use();
    gl.GenFramebuffers(1, &frame_);
    gl.BindFramebuffer(GL_FRAMEBUFFER, frame_);
    gl.GenRenderbuffers(kTargets + 1, planes_);
    const GLenum formats[] = {GL_R32F, GL_R32I, GL_RGBA32F, GL_DEPTH_COMPONENT32F};
    const GLenum places[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2, GL_DEPTH_ATTACHMENT};
    for (int i = 0; i <= kTargets; ++i) {
      gl.BindRenderbuffer(GL_RENDERBUFFER, planes_[i]);
      gl.RenderbufferStorage(GL_RENDERBUFFER, formats[i], width, height);
      gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, places[i], GL_RENDERBUFFER, planes_[i]);
    }
    gl.DrawBuffers(kTargets, places);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw std::runtime_error("OSMesa cannot draw depth, ids and normals in one pass");
    width_ = width;
    height_ = height;
  }
  void free() {
    if (frame_ == 0) return;
    const GlFunctions& gl = context_.use();
    gl.DeleteRenderbuffers(kTargets + 1, planes_);
    gl.DeleteFramebuffers(1, &frame_);
    frame_ = 0;
  }

  GlContext& context_;
  GLuint frame_ = 0;
  GLuint planes_[kTargets + 1] = {};
  int width_ = 0, height_ = 0;
};

class OsmesaRenderer : public DepthRenderer {
 public:
  OsmesaRenderer()
      : meshes_(context_), target_(context_), program_(context_.make_program(kVertexShader, kFragmentShader)) {
    const GlFunctions& gl = context_.use();
    const auto at = [&](const char* name) { return gl.GetUniformLocation(program_, name); };
    at_ = {at("X_CO"), at("R_CO"), at("scale"), at("shift"), at("depth"), at("normals_O"), at("id")};
  }

  ExactFrame render(const RenderScene& scene, const PinholeCamera& camera, const Pose& X_WC, double near,
                    double far) override {
    BP_CHECK(near > 0 && far > near, near << " .. " << far);
    meshes_.drop_unused();
    begin(camera, near, far);
    const Pose X_CW = X_WC.inverse();
    for (const RenderItem& item : scene.items) draw(item, X_CW * item.X_WO);
    ExactFrame frame = read(camera.width, camera.height);
    frame.materials = MaterialTable(scene);
    context_.check("render");
    return frame;
  }

  Image<Rgb> picture(const RenderScene& scene, const PinholeCamera& camera, const Pose& X_WC) override {
    return shaded_picture(*this, scene, camera, X_WC);
  }

  std::string description() const override { return context_.description(); }

 private:
  struct Uniforms {
    GLint X_CO, R_CO, scale, shift, depth, normals_O, id;
  };

  void begin(const PinholeCamera& camera, double near, double far) {
    target_.bind(camera.width, camera.height);
    const GlFunctions& gl = context_.use();
    const float no_depth[4] = {0, 0, 0, 0}, farthest = 1;
    const GLint no_id[4] = {kIdNothing, 0, 0, 0};
    gl.ClearBufferfv(GL_COLOR, 0, no_depth);
    gl.ClearBufferiv(GL_COLOR, 1, no_id);
    gl.ClearBufferfv(GL_COLOR, 2, no_depth);
    gl.ClearBufferfv(GL_DEPTH, 0, &farthest);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_LESS);  // at equal depth the earlier item stays
    gl.Disable(GL_CULL_FACE);
    gl.UseProgram(program_);
    const auto set2 = [&](GLint place, double x, double y) {
      gl.Uniform2f(place, static_cast<float>(x), static_cast<float>(y));
    };
    set2(at_.scale, 2 * camera.fx / camera.width, 2 * camera.fy / camera.height);
    set2(at_.shift, 2 * (camera.cx + 0.5) / camera.width - 1, 2 * (camera.cy + 0.5) / camera.height - 1);
    set2(at_.depth, (far + near) / (far - near), -2 * far * near / (far - near));
    gl.Uniform1i(at_.normals_O, 0);
  }

  void draw(const RenderItem& item, const Pose& X_CO) {
    const GlMesh& mesh = meshes_.get(item.mesh_O);
    if (mesh.index_count == 0) return;
    const GlFunctions& gl = context_.use();
    const Eigen::Matrix4f X = X_CO.matrix().cast<float>();
    const Eigen::Matrix3f R = X.topLeftCorner<3, 3>();
    gl.UniformMatrix4fv(at_.X_CO, 1, GL_FALSE, X.data());
    gl.UniformMatrix3fv(at_.R_CO, 1, GL_FALSE, R.data());
    gl.Uniform1i(at_.id, item.id);
    gl.BindTexture(GL_TEXTURE_BUFFER, mesh.normal_texture);
    gl.BindVertexArray(mesh.vertex_array);
    gl.DrawElements(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr);
    gl.BindVertexArray(0);
  }

  ExactFrame read(int width, int height) {
    const GlFunctions& gl = context_.use();
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    ExactFrame frame;
    frame.depth = Image<float>(width, height);
    frame.ids = Image<std::int32_t>(width, height);
    frame.normals_C = Image<Eigen::Vector3f>(width, height, Eigen::Vector3f::Zero());
    Image<Eigen::Vector4f> normals(width, height, Eigen::Vector4f::Zero());
    gl.ReadBuffer(GL_COLOR_ATTACHMENT0);
    gl.ReadPixels(0, 0, width, height, GL_RED, GL_FLOAT, frame.depth.data());
    gl.ReadBuffer(GL_COLOR_ATTACHMENT1);
    gl.ReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_INT, frame.ids.data());
    gl.ReadBuffer(GL_COLOR_ATTACHMENT2);
    gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, normals.data());
    for (std::size_t i = 0; i < frame.ids.size(); ++i) {
      if (frame.ids[i] == kIdNothing) {
        frame.depth[i] = std::numeric_limits<float>::quiet_NaN();
      } else {
        frame.normals_C[i] = normals[i].head<3>().normalized();
      }
    }
    return frame;
  }

  mutable GlContext context_;  // first in, last out: the others live inside it
  GlMeshCache meshes_;
  FrameTarget target_;
  GLuint program_;
  Uniforms at_{};
};

}  // namespace

std::unique_ptr<DepthRenderer> make_osmesa_renderer() { return std::make_unique<OsmesaRenderer>(); }

}  // namespace binpick
