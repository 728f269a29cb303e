// OSMesa behind the DepthRenderer interface: it tells which triangle of which item comes first in every pixel (RG32I,
// one pass, a 32-bit float depth buffer); depth and normals follow from that triangle in double (sim/facets). Items
// outside the picture are not drawn, and of closed ones only the front faces.

#include <algorithm>
#include <stdexcept>

#include "core/check.hpp"
#include "sim/depth_renderer.hpp"
#include "sim/facets.hpp"
#include "sim/gl_context.hpp"
#include "sim/gl_mesh_cache.hpp"
#include "sim/picture.hpp"

namespace binpick {
namespace {

// GL samples pixel (u, v) at window (u + 1/2, v + 1/2); PinholeCamera has its centre at (u, v). Image row v is GL row
// v, so the picture is upside down for GL and needs no flip on reading.
constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec4 p_O;  // w: number of the triangle that ends here
uniform mat4 X_CO;
uniform vec2 scale;    // 2 f / size
uniform vec2 shift;    // 2 (c + 1/2) / size - 1
uniform vec2 depth;    // (far + near) / (far - near), -2 far near / (far - near)
flat out float triangle;
void main() {
  triangle = p_O.w;
  vec3 p_C = (X_CO * vec4(p_O.xyz, 1.0)).xyz;
  gl_Position = vec4(scale * p_C.xy + shift * p_C.z, depth.x * p_C.z + depth.y, p_C.z);
}
)";

constexpr const char* kFragmentShader = R"(#version 330 core
uniform int item;
flat in float triangle;
layout(location = 0) out ivec2 seen;
void main() { seen = ivec2(item, int(triangle)); }
)";

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
    gl.GenRenderbuffers(2, planes_);
    const GLenum formats[] = {GL_RG32I, GL_DEPTH_COMPONENT32F}, places[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
    for (int i = 0; i < 2; ++i) {
      gl.BindRenderbuffer(GL_RENDERBUFFER, planes_[i]);
      gl.RenderbufferStorage(GL_RENDERBUFFER, formats[i], width, height);
      gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, places[i], GL_RENDERBUFFER, planes_[i]);
    }
    gl.DrawBuffers(1, places);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw std::runtime_error("OSMesa cannot draw pairs of integers with a 32-bit depth buffer");
    width_ = width;
    height_ = height;
  }
  void free() {
    if (frame_ == 0) return;
    const GlFunctions& gl = context_.use();
    gl.DeleteRenderbuffers(2, planes_);
    gl.DeleteFramebuffers(1, &frame_);
    frame_ = 0;
  }

  GlContext& context_;
  GLuint frame_ = 0;
  GLuint planes_[2] = {};
  int width_ = 0, height_ = 0;
};

class OsmesaRenderer : public DepthRenderer {
 public:
  OsmesaRenderer()
      : meshes_(context_), target_(context_), program_(context_.make_program(kVertexShader, kFragmentShader)) {
    const GlFunctions& gl = context_.use();
    const auto at = [&](const char* name) { return gl.GetUniformLocation(program_, name); };
    at_ = {at("X_CO"), at("scale"), at("shift"), at("depth"), at("item")};
  }

  ExactFrame render(const RenderScene& scene, const PinholeCamera& camera, const Pose& X_WC, double near,
                    double far) override {
    BP_CHECK(near > 0 && far > near, near << " .. " << far);
    meshes_.drop_unused();
    FacetView view{scene, camera, near, far, {}, {}};
    const Pose X_CW = X_WC.inverse();
    std::vector<const GlMesh*> meshes;
    for (const RenderItem& item : scene.items) {
      meshes.push_back(&meshes_.get(item.mesh_O));
      view.X_CO.push_back(X_CW * item.X_WO);
      view.facets.push_back(meshes.back()->facets.get());
    }
    begin(camera, near, far);
    for (std::size_t i = 0; i < meshes.size(); ++i)
      if (meshes[i]->index_count > 0 && may_be_seen(view, i)) draw(view, i, *meshes[i]);
    const Image<FacetId>& seen = read(camera.width, camera.height);
    context_.check("render");
    return frame_of(view, seen);
  }

  Image<Rgb> picture(const RenderScene& scene, const PinholeCamera& camera, const Pose& X_WC) override {
    return shaded_picture(*this, scene, camera, X_WC);
  }

  std::string description() const override { return context_.description(); }

 private:
  struct Uniforms {
    GLint X_CO, scale, shift, depth, item;
  };

  void begin(const PinholeCamera& camera, double near, double far) {
    target_.bind(camera.width, camera.height);
    const GlFunctions& gl = context_.use();
    const float farthest = 1;
    const GLint nothing[4] = {-1, 0, 0, 0};
    gl.ClearBufferiv(GL_COLOR, 0, nothing);
    gl.ClearBufferfv(GL_DEPTH, 0, &farthest);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_LESS);  // at equal depth the earlier item stays
    gl.CullFace(GL_BACK);
    gl.FrontFace(GL_CW);  // rows run downwards for us, upwards for GL
    gl.UseProgram(program_);
    const auto set2 = [&](GLint place, double x, double y) {
      gl.Uniform2f(place, static_cast<float>(x), static_cast<float>(y));
    };
    set2(at_.scale, 2 * camera.fx / camera.width, 2 * camera.fy / camera.height);
    set2(at_.shift, 2 * (camera.cx + 0.5) / camera.width - 1, 2 * (camera.cy + 0.5) / camera.height - 1);
    set2(at_.depth, (far + near) / (far - near), -2 * far * near / (far - near));
  }

  void draw(const FacetView& view, std::size_t item, const GlMesh& mesh) {
    const GlFunctions& gl = context_.use();
    const Eigen::Matrix4f X = view.X_CO[item].matrix().cast<float>();
    gl.UniformMatrix4fv(at_.X_CO, 1, GL_FALSE, X.data());
    gl.Uniform1i(at_.item, static_cast<GLint>(item));
    hides_its_back(view, item) ? gl.Enable(GL_CULL_FACE) : gl.Disable(GL_CULL_FACE);
    gl.BindVertexArray(mesh.vertex_array);
    gl.DrawElements(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr);
    gl.BindVertexArray(0);
  }

  const Image<FacetId>& read(int width, int height) {
    static_assert(sizeof(FacetId) == 2 * sizeof(GLint));
    if (seen_.width() != width || seen_.height() != height) seen_ = Image<FacetId>(width, height);
    const GlFunctions& gl = context_.use();
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl.ReadBuffer(GL_COLOR_ATTACHMENT0);
    gl.ReadPixels(0, 0, width, height, GL_RG_INTEGER, GL_INT, seen_.data());
    return seen_;
  }

  mutable GlContext context_;  // first in, last out: the others live inside it
  GlMeshCache meshes_;
  FrameTarget target_;
  GLuint program_;
  Uniforms at_{};
  Image<FacetId> seen_;  // read into again and again
};

}  // namespace

std::unique_ptr<DepthRenderer> make_osmesa_renderer() { return std::make_unique<OsmesaRenderer>(); }

}  // namespace binpick
