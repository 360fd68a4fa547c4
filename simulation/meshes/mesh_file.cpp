#include "simulation/meshes/mesh_file.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <assimp/Importer.hpp>
#include <cmath>
#include <exception>
#include <string>

#include "simulation/meshes/ply_header.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3f;

constexpr float kFarthest = 10'000;   // metres
constexpr float kLeastArea = 1e-12F;  // twice, square metres
constexpr const char* kNoFaces =
    "expected faces, found none (points alone are a cloud, not a mesh)";

Error complaint(const std::filesystem::path& path, const std::string& what) {
  return {fmt::format("{}: {}", path.string(), what)};
}

/// Adds a vertex list; an Error when one cannot stand in a world.
Status add_vertices(const std::filesystem::path& path, const aiMesh& part, Mesh& mesh) {
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const Vector3f p(part.mVertices[i].x, part.mVertices[i].y, part.mVertices[i].z);
    if (!p.allFinite()) {
      return complaint(path, fmt::format("vertex {}: expected finite coordinates, found {} {} {}",
                                         mesh.vertices.size(), p.x(), p.y(), p.z()));
    }
    if (p.cwiseAbs().maxCoeff() > kFarthest) {
      return complaint(path, fmt::format("vertex {}: expected coordinates within 10 km, found "
                                         "{} {} {}; move the mesh to its origin",
                                         mesh.vertices.size(), p.x(), p.y(), p.z()));
    }
    mesh.vertices.push_back(p);
  }
  return Done{};
}

void add_triangles(const aiMesh& part, std::uint32_t first, Mesh& mesh) {
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;
    const std::array<std::uint32_t, 3> corners = {
        first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]};
    const Vector3f& a = mesh.vertices[corners[0]];
    const Vector3f b = mesh.vertices[corners[1]] - a;
    const Vector3f c = mesh.vertices[corners[2]] - a;
    if (b.cross(c).norm() > kLeastArea) mesh.triangles.push_back(corners);
  }
}

/// Assimp fills what a file lacks with zeros; a cut file shall be an error.
Status check_ply(const std::filesystem::path& path) {
  const auto header = read_ply_header(path);
  if (!header) return complaint(path, "expected a .ply header, found none that ends");
  if (header->faces == 0) return complaint(path, kNoFaces);
  if (is_cut_off(path, *header)) {
    return complaint(path, fmt::format("expected {} vertices and faces, found the end of the file "
                                       "before",
                                       header->entries));
  }
  return Done{};
}

Result<Mesh> mesh_of(const std::filesystem::path& path) {
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_SortByPType |
                                           aiProcess_PreTransformVertices);
  if (scene == nullptr) {
    return complaint(path, fmt::format("expected a mesh, found what cannot be read as one: {}",
                                       importer.GetErrorString()));
  }
  Mesh mesh;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    if (auto added = add_vertices(path, *scene->mMeshes[i], mesh); !added) return added.error();
    add_triangles(*scene->mMeshes[i], first, mesh);
  }
  if (mesh.triangles.empty()) return complaint(path, kNoFaces);
  return mesh;
}

}  // namespace

Result<Mesh> read_mesh(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  if (ending != ".ply" && ending != ".obj") {
    return complaint(path,
                     fmt::format("expected a mesh in a .ply or .obj file, found '{}'", ending));
  }
  if (std::error_code unknown; !std::filesystem::is_regular_file(path, unknown)) {
    return complaint(path, "expected a mesh, found no such file");
  }
  if (ending == ".ply") {
    if (auto sound = check_ply(path); !sound) return sound.error();
  }
  try {
    return mesh_of(path);
  } catch (const std::exception& e) {
    return complaint(
        path, fmt::format("expected a mesh, found what cannot be read as one: {}", e.what()));
  }
}

bool has_faces(const std::filesystem::path& ply) {
  const auto header = read_ply_header(ply);
  return header && header->faces > 0;
}

}  // namespace holdfast::simulation
