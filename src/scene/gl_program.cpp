#include "scene/gl_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace gaitpad {
namespace {

using Shader = GlName<FreeShader>;

// First line of the compiler's log.
template <class GetLength, class GetText>
std::string log_of(GLuint name, GetLength get_length, GetText get_text) {
  GLint size = 0;
  get_length(name, GL_INFO_LOG_LENGTH, &size);
  std::string text(static_cast<std::size_t>(std::clamp(size, 1, 4096)), '\0');
  get_text(name, static_cast<GLsizei>(text.size()), nullptr, text.data());
  return drawable(text.substr(0, text.find_first_of(std::string("\n\0", 2))));
}

Result<Shader> compiled(const char* name, GLenum kind, const std::string& text) {
  Shader shader(glCreateShader(kind));
  const char* source = text.c_str();
  glShaderSource(shader.get(), 1, &source, nullptr);
  glCompileShader(shader.get());
  GLint is_good = GL_FALSE;
  glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &is_good);
  if (is_good == GL_TRUE) return shader;
  return Error{fmt::format("OpenGL: {} shader of the {}: {}",
                           kind == GL_VERTEX_SHADER ? "vertex" : "fragment", name,
                           log_of(shader.get(), glGetShaderiv, glGetShaderInfoLog))};
}

template <class Name>
Name generated(void (*generate)(GLsizei, GLuint*)) {
  GLuint name = 0;
  generate(1, &name);
  return Name(name);
}

}  // namespace

GlVertexArray new_vertex_array() { return generated<GlVertexArray>(glGenVertexArrays); }
GlFrameBuffer new_frame_buffer() { return generated<GlFrameBuffer>(glGenFramebuffers); }
GlRenderBuffer new_render_buffer() { return generated<GlRenderBuffer>(glGenRenderbuffers); }
GlTexture new_texture() { return generated<GlTexture>(glGenTextures); }

void GlRows::add(Of of, std::initializer_list<RowPart> parts) {
  const auto kind = static_cast<std::size_t>(of);
  if (vertices_.get() == 0) vertices_ = new_vertex_array();
  buffer_[kind] = generated<GlBuffer>(glGenBuffers);
  glBindVertexArray(vertices_.get());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_[kind].get());
  GLsizei row_bytes = 0;
  for (const RowPart& part : parts) row_bytes += part.floats * GLsizei{sizeof(float)};
  std::size_t offset = 0;
  for (const RowPart& part : parts) {
    glEnableVertexAttribArray(part.location);
    glVertexAttribPointer(part.location, part.floats, GL_FLOAT, GL_FALSE, row_bytes,
                          reinterpret_cast<const void*>(offset));
    glVertexAttribDivisor(part.location, of == Of::instance ? 1 : 0);
    offset += static_cast<std::size_t>(part.floats) * sizeof(float);
  }
  glBindVertexArray(0);
}

void GlRows::load(Of of, const void* data, std::size_t count, std::size_t row_bytes) {
  const auto kind = static_cast<std::size_t>(of);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_[kind].get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(count * row_bytes), data, GL_STREAM_DRAW);
  count_[kind] = static_cast<GLsizei>(count);
}

void GlRows::load_triangles(const std::vector<std::uint32_t>& indices) {
  if (indices_.get() == 0) indices_ = generated<GlBuffer>(glGenBuffers);
  glBindVertexArray(vertices_.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(GLuint)),
               indices.data(), GL_DYNAMIC_DRAW);
  index_count_ = static_cast<GLsizei>(indices.size());
}

void GlRows::draw_squares(GLsizei count) const {
  glBindVertexArray(vertices_.get());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count);
}

void GlRows::draw_triangles() const {
  glBindVertexArray(vertices_.get());
  if (index_count_ > 0) {
    glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
  } else {
    glDrawArrays(GL_TRIANGLES, 0, count_[0]);
  }
}

void GlRows::draw_triangles_of(GLsizei instances) const {
  glBindVertexArray(vertices_.get());
  glDrawElementsInstanced(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr, instances);
}

std::optional<Error> GlProgram::link(const char* name, const std::string& vertex,
                                     const std::string& fragment) {
  const auto first = compiled(name, GL_VERTEX_SHADER, vertex);
  if (!first) return first.error();
  const auto second = compiled(name, GL_FRAGMENT_SHADER, fragment);
  if (!second) return second.error();
  name_ = GlName<FreeProgram>(glCreateProgram());
  const GLuint id = name_.get();
  for (const Shader* shader : {&*first, &*second}) glAttachShader(id, shader->get());
  glLinkProgram(id);
  for (const Shader* shader : {&*first, &*second}) glDetachShader(id, shader->get());
  GLint is_good = GL_FALSE;
  glGetProgramiv(id, GL_LINK_STATUS, &is_good);
  if (is_good == GL_TRUE) return std::nullopt;
  return Error{fmt::format("OpenGL: the shaders of the {}: {}", name,
                           log_of(id, glGetProgramiv, glGetProgramInfoLog))};
}

void GlProgram::set(const char* uniform, double value) const {
  glUniform1f(location(uniform), static_cast<float>(value));
}
void GlProgram::set(const char* uniform, const vec2& value) const {
  glUniform2f(location(uniform), static_cast<float>(value.x), static_cast<float>(value.y));
}
void GlProgram::set(const char* uniform, const vec3& value) const {
  glUniform3f(location(uniform), static_cast<float>(value.x), static_cast<float>(value.y),
              static_cast<float>(value.z));
}
void GlProgram::set(const char* uniform, const Colour& value) const {
  set(uniform, vec3(value.red, value.green, value.blue));
}
void GlProgram::set(const char* uniform, const glm::dmat4& value) const {
  std::array<float, 16> m;
  for (int i = 0; i < 16; ++i) m[i] = static_cast<float>(value[i / 4][i % 4]);
  glUniformMatrix4fv(location(uniform), 1, GL_FALSE, m.data());
}

}  // namespace gaitpad
