#include "view/scene.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "view/scene_bodies.h"
#include "view/scene_floor.h"
#include "view/scene_strokes.h"

namespace gaitpad {
namespace {

constexpr int kSamples = 4;
constexpr int kLargest_px = 16384;

// Software rasterizers of Mesa, of Google and of Windows under a layer.
bool is_software_renderer(const std::string& name) {
  for (const char* part : {"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software"}) {
    if (name.find(part) != std::string::npos) return true;
  }
  return false;
}

// Colour and depth of a size, with several samples a pixel or one.
class Target {
 public:
  // False where the renderer cannot.
  bool resize(int width, int height, int samples) {
    if (width == width_ && height == height_ && samples == samples_) return is_complete_;
    width_ = width;
    height_ = height;
    samples_ = samples;
    frame_ = new_frame_buffer();
    colour_ = new_render_buffer();
    depth_ = new_render_buffer();
    glBindFramebuffer(GL_FRAMEBUFFER, frame_.get());
    attach(colour_, GL_RGBA8, GL_COLOR_ATTACHMENT0);
    attach(depth_, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
    is_complete_ = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    return is_complete_;
  }
  GLuint name() const noexcept { return frame_.get(); }

 private:
  void attach(const GlRenderBuffer& buffer, GLenum format, GLenum place) const {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer.get());
    if (samples_ > 1) {
      glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_, format, width_, height_);
    } else {
      glRenderbufferStorage(GL_RENDERBUFFER, format, width_, height_);
    }
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer.get());
  }
  GlFrameBuffer frame_;
  GlRenderBuffer colour_, depth_;
  int width_ = 0, height_ = 0, samples_ = 0;
  bool is_complete_ = false;
};

void blit(GLuint from, GLuint to, int width, int height, int x, int y) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
  glBlitFramebuffer(0, 0, width, height, x, y, x + width, y + height, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
}

SceneView view_of(const Camera& camera, const SceneContent& content, const Theme& theme,
                  const Viewport& viewport, double scale) {
  SceneView view;
  view.camera = camera;
  view.origin_m = glm::round(vec3(camera.target_m.x, 0.0, camera.target_m.z));
  if (!is_finite(content.focus_m) || !is_finite(view.origin_m)) view.origin_m = vec3(0.0);
  mat4 moved(1.0);
  moved[3] = glm::dvec4(view.origin_m, 1.0);
  view.size_px = vec2(viewport.width, viewport.height);
  view.to_clip = camera.projection(view.size_px.x / view.size_px.y) * camera.view() * moved;
  view.scale = scale;
  view.theme = &theme;
  return view;
}

}  // namespace

struct Scene::Impl {
  Impl(SceneBodies&& b, SceneFloor&& f, SceneStrokes&& s)
      : bodies(std::move(b)), floor(std::move(f)), strokes(std::move(s)) {}

  SceneBodies bodies;
  SceneFloor floor;
  SceneStrokes strokes;
  Target target, resolved;
  std::string renderer;
  int samples = 1;
  bool is_software = false;
};

Scene::Scene() = default;
Scene::~Scene() = default;
const std::string& Scene::renderer() const noexcept { return impl_->renderer; }
bool Scene::is_software() const noexcept { return impl_->is_software; }

Result<std::unique_ptr<Scene>> Scene::create(Quality quality) {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (!name) return Error{"OpenGL: there is no context to draw with"};
  const bool is_software = is_software_renderer(name);
  const bool is_fine = quality == Quality::high || (quality == Quality::automatic && !is_software);
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  auto bodies = SceneBodies::create(is_fine ? MeshDetail{24, 6, 1024} : MeshDetail{16, 4, 384});
  if (!bodies) return bodies.error();
  auto strokes = SceneStrokes::create();
  if (!strokes) return strokes.error();
  auto floor = SceneFloor::create();
  if (!floor) return floor.error();
  std::unique_ptr<Scene> scene(new Scene);
  scene->impl_ = std::make_unique<Impl>(std::move(*bodies), std::move(*floor), std::move(*strokes));
  scene->impl_->samples = is_fine ? std::clamp(most, 1, kSamples) : 1;
  scene->impl_->is_software = is_software;
  const int version = epoxy_gl_version();
  const std::string smoothing =
      scene->impl_->samples > 1 ? fmt::format("{}x", scene->impl_->samples) : "no";
  scene->impl_->renderer = fmt::format("{}, OpenGL {}.{}, {} anti-aliasing", drawable(name),
                                       version / 10, version % 10, smoothing);
  return scene;
}

void Scene::draw(const SceneContent& content, const Camera& camera, const Theme& theme,
                 const Viewport& viewport, int window_height_px, double scale) {
  Impl& s = *impl_;
  const int width = viewport.width, height = viewport.height;
  if (width < 1 || height < 1 || width > kLargest_px || height > kLargest_px) return;
  GLint window = 0;
  std::array<GLint, 4> before{};
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &window);
  glGetIntegerv(GL_VIEWPORT, before.data());
  glDisable(GL_SCISSOR_TEST);
  // What cannot be had with many samples a pixel (memory) can perhaps with one.
  if (!s.target.resize(width, height, s.samples)) s.samples = 1;
  if (s.target.resize(width, height, s.samples)) {
    const SceneView view = view_of(camera, content, theme, viewport, scale);
    s.bodies.load(content, view);
    const ShadowPlace shadow = content.has_shadows ? s.bodies.draw_shadows() : ShadowPlace{};
    glBindFramebuffer(GL_FRAMEBUFFER, s.target.name());
    glViewport(0, 0, width, height);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    glClear(GL_DEPTH_BUFFER_BIT);
    s.bodies.draw(view);
    s.floor.draw(content, view, shadow, s.bodies.shadow_texture());
    s.strokes.draw(content, view);
    glDisable(GL_DEPTH_TEST);
    GLuint ready = s.target.name();
    if (s.samples > 1 && s.resolved.resize(width, height, 1)) {
      blit(ready, s.resolved.name(), width, height, 0, 0);
      ready = s.resolved.name();
    }
    blit(ready, static_cast<GLuint>(window), width, height, viewport.x,
         window_height_px - viewport.y - height);
  }
  glBindVertexArray(0);
  glUseProgram(0);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(window));
  glViewport(before[0], before[1], before[2], before[3]);
}

}  // namespace gaitpad
