// OpenGL objects that free themselves, and shader programs whose errors become sentences. Each
// object needs the context that was current when it was made.
#pragma once
#include <epoxy/gl.h>

#include <string>
#include <utility>

#include "draw/picture.h"
#include "gaitpad/math.h"
#include "gaitpad/result.h"

namespace gaitpad {

// The name of an OpenGL object; `Free` deletes the object.
template <class Free>
class GlName {
 public:
  explicit GlName(GLuint name = 0) noexcept : name_(name) {}
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlName() {
    if (name_ != 0) Free{}(name_);
  }
  GLuint get() const noexcept { return name_; }

 private:
  GLuint name_;
};
struct FreeProgram {
  void operator()(GLuint name) const noexcept { glDeleteProgram(name); }
};
struct FreeShader {
  void operator()(GLuint name) const noexcept { glDeleteShader(name); }
};
struct FreeBuffer {
  void operator()(GLuint name) const noexcept { glDeleteBuffers(1, &name); }
};
struct FreeVertexArray {
  void operator()(GLuint name) const noexcept { glDeleteVertexArrays(1, &name); }
};
struct FreeFrameBuffer {
  void operator()(GLuint name) const noexcept { glDeleteFramebuffers(1, &name); }
};
struct FreeRenderBuffer {
  void operator()(GLuint name) const noexcept { glDeleteRenderbuffers(1, &name); }
};
struct FreeTexture {
  void operator()(GLuint name) const noexcept { glDeleteTextures(1, &name); }
};
using GlBuffer = GlName<FreeBuffer>;
using GlVertexArray = GlName<FreeVertexArray>;
using GlFrameBuffer = GlName<FreeFrameBuffer>;
using GlRenderBuffer = GlName<FreeRenderBuffer>;
using GlTexture = GlName<FreeTexture>;

GlBuffer new_buffer();
GlVertexArray new_vertex_array();
GlFrameBuffer new_frame_buffer();
GlRenderBuffer new_render_buffer();
GlTexture new_texture();

// A part of a row of floats, one row for each vertex or instance: `floats` numbers for attribute
// `location`.
struct VertexPart {
  GLuint location;
  GLint floats;
};
// Applies to the bound vertex array and buffer. `divisor` 1: one row for each instance, 0: for each
// vertex.
void set_vertex_parts(const VertexPart* parts, int count, GLuint divisor);
// Replaces the buffer's content.
void upload(const GlBuffer& buffer, const void* data, std::size_t bytes);

class GlProgram {
 public:
  GlProgram() = default;
  // `name` identifies the program in the error if a shader does not compile.
  static Result<GlProgram> link(const char* name, const std::string& vertex,
                                const std::string& fragment);
  void use() const { glUseProgram(name_.get()); }
  // The program has to be in use. A name that the shaders do not use is ignored.
  void set(const char* uniform, double value) const;
  void set(const char* uniform, const vec2& value) const;
  void set(const char* uniform, const vec3& value) const;
  void set(const char* uniform, const Colour& value) const;  // vec3, without alpha
  void set(const char* uniform, const glm::dmat4& value) const;

 private:
  GLint location(const char* uniform) const { return glGetUniformLocation(name_.get(), uniform); }
  GlName<FreeProgram> name_;
};

}  // namespace gaitpad
