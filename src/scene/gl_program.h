// OpenGL objects that free themselves, and shader programs that report errors as sentences. Each
// object needs the context in which it was made.
#pragma once
#include <epoxy/gl.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

GlVertexArray new_vertex_array();
GlFrameBuffer new_frame_buffer();
GlRenderBuffer new_render_buffer();
GlTexture new_texture();

// A part of a row: `floats` numbers for attribute `location`.
struct RowPart {
  GLuint location;
  GLint floats;
};
// The input of a program: rows of floats, one for each vertex or instance, and triangles as indices
// of vertices.
class GlRows {
 public:
  enum class Of : std::uint8_t { vertex, instance };
  // Describes the parts of a row; call it before load().
  void add(Of of, std::initializer_list<RowPart> parts);
  // Replaces the rows; load_triangles() replaces the indices.
  template <class Row>
  void load(Of of, const std::vector<Row>& rows) {
    load(of, rows.data(), rows.size(), sizeof(Row));
  }
  void load_triangles(const std::vector<std::uint32_t>& indices);

  // Draws all instances, or the first `count`, as squares whose corners the vertex shader computes.
  void draw_squares() const { draw_squares(count_[1]); }
  void draw_squares(GLsizei count) const;
  // Draws the triangles of the indices or, without indices, of each three vertices.
  void draw_triangles() const;
  void draw_triangles_of(GLsizei instances) const;

 private:
  void load(Of of, const void* data, std::size_t count, std::size_t row_bytes);
  GlVertexArray vertices_;
  std::array<GlBuffer, 2> buffer_;  // a buffer of vertices and one of instances, indexed by Of
  std::array<GLsizei, 2> count_ = {};
  GlBuffer indices_;
  GLsizei index_count_ = 0;
};

class GlProgram {
 public:
  // `name` identifies the program in the error if a shader does not compile.
  std::optional<Error> link(const char* name, const std::string& vertex,
                            const std::string& fragment);
  void use() const { glUseProgram(name_.get()); }
  // The program has to be in use. A name that the shaders do not use is ignored.
  void set(const char* uniform, double value) const;
  void set(const char* uniform, const vec2& value) const;
  void set(const char* uniform, const vec3& value) const;
  // Sets a vec3: the colour without its alpha.
  void set(const char* uniform, const Colour& value) const;
  void set(const char* uniform, const glm::dmat4& value) const;

 private:
  GLint location(const char* uniform) const { return glGetUniformLocation(name_.get(), uniform); }
  GlName<FreeProgram> name_;
};

}  // namespace gaitpad
