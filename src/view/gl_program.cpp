#include "view/gl_program.h"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace gaitpad {
namespace {

using Shader = GlName<FreeShader>;

// The first line of the compiler's log.
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

GlBuffer new_buffer() { return generated<GlBuffer>(glGenBuffers); }
GlVertexArray new_vertex_array() { return generated<GlVertexArray>(glGenVertexArrays); }
GlFrameBuffer new_frame_buffer() { return generated<GlFrameBuffer>(glGenFramebuffers); }
GlRenderBuffer new_render_buffer() { return generated<GlRenderBuffer>(glGenRenderbuffers); }
GlTexture new_texture() { return generated<GlTexture>(glGenTextures); }

void set_vertex_parts(const VertexPart* parts, int count, GLuint divisor) {
  GLsizei stride = 0;
  for (int i = 0; i < count; ++i) stride += parts[i].floats * GLsizei{sizeof(float)};
  std::size_t offset = 0;
  for (int i = 0; i < count; ++i) {
    glEnableVertexAttribArray(parts[i].location);
    glVertexAttribPointer(parts[i].location, parts[i].floats, GL_FLOAT, GL_FALSE, stride,
                          reinterpret_cast<const void*>(offset));
    glVertexAttribDivisor(parts[i].location, divisor);
    offset += static_cast<std::size_t>(parts[i].floats) * sizeof(float);
  }
}

void upload(const GlBuffer& buffer, const void* data, std::size_t bytes) {
  glBindBuffer(GL_ARRAY_BUFFER, buffer.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_STREAM_DRAW);
}

Result<GlProgram> GlProgram::link(const char* name, const std::string& vertex,
                                  const std::string& fragment) {
  const auto first = compiled(name, GL_VERTEX_SHADER, vertex);
  if (!first) return first.error();
  const auto second = compiled(name, GL_FRAGMENT_SHADER, fragment);
  if (!second) return second.error();
  GlProgram program;
  program.name_ = GlName<FreeProgram>(glCreateProgram());
  const GLuint id = program.name_.get();
  for (const Shader* shader : {&*first, &*second}) glAttachShader(id, shader->get());
  glLinkProgram(id);
  for (const Shader* shader : {&*first, &*second}) glDetachShader(id, shader->get());
  GLint is_good = GL_FALSE;
  glGetProgramiv(id, GL_LINK_STATUS, &is_good);
  if (is_good == GL_TRUE) return program;
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
