#include "meshing.h"

#include <gmsh.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <map>
#include <new>

namespace Squeal
{
  namespace
  {
    /// Runs one step. Gmsh carries on after most errors: a call that returns has not necessarily succeeded.
    void attempt(const std::string &step, const std::function<void()> &action)
    {
      bool failed = false;
      try
        {
          action();
        }
      catch (const std::bad_alloc &)
        {
          throw;
        }
      catch (...) // 4.8 throws integers in places, strings in others
        {
          failed = true;
        }
      std::vector<std::string> log;
      gmsh::logger::get(log);
      if (failed || std::any_of(log.begin(), log.end(), [](const std::string &line) { return line.rfind("Error", 0) == 0; }))
        throw GmshError("Gmsh failed while " + step);
    }

    /// Elements by their type.
    struct Elements
    {
      /// Of one entity, or of all of a dimension.
      explicit Elements(const int dimension, const int entity = -1)
      {
        gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
      }

      std::vector<int>                      types;
      std::vector<std::vector<std::size_t>> tags, nodes;
    };

    /// Groups of all entities with physical names or numbers: dimension and tag, ascending.
    gmsh::vectorpair physical_groups()
    {
      gmsh::vectorpair groups;
      gmsh::model::getPhysicalGroups(groups);
      std::sort(groups.begin(), groups.end());
      return groups;
    }

    /// Index of each node by its tag.
    std::map<std::size_t, unsigned int> collect_nodes(GmshMesh &mesh)
    {
      std::vector<std::size_t> tags;
      std::vector<double>      coordinates, parametric;
      gmsh::model::mesh::getNodes(tags, coordinates, parametric);
      std::map<std::size_t, unsigned int> nodes;
      for (std::size_t i = 0; i < tags.size(); ++i)
        nodes.emplace(tags[i], i);
      for (auto &[tag, i] : nodes)
        {
          mesh.points.push_back({{coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]}});
          i = mesh.points.size() - 1;
        }
      return nodes;
    }

    void add_elements(GmshMesh::Group &group, const Elements &elements, const std::map<std::size_t, unsigned int> &nodes)
    {
      for (std::size_t t = 0; t < elements.types.size(); ++t)
        {
          std::string         type;
          int                 dimension, order, n_nodes, n_primary_nodes;
          std::vector<double> local_coordinates;
          gmsh::model::mesh::getElementProperties(elements.types[t], type, dimension, order, n_nodes, local_coordinates, n_primary_nodes);
          for (std::size_t i = 0; i < elements.tags[t].size(); ++i)
            {
              GmshMesh::Element element{elements.tags[t][i], {}};
              for (int v = 0; v < n_nodes; ++v)
                element.nodes.push_back(nodes.at(elements.nodes[t][i * n_nodes + v]));
              group.elements[type].push_back(element);
            }
        }
    }

    GmshMesh collect_mesh()
    {
      GmshMesh   mesh;
      const auto nodes = collect_nodes(mesh);
      for (const auto &[dimension, tag] : physical_groups())
        {
          GmshMesh::Group  group{dimension, "", {}};
          std::vector<int> entities;
          gmsh::model::getPhysicalName(dimension, tag, group.name);
          gmsh::model::getEntitiesForPhysicalGroup(dimension, tag, entities);
          for (const int entity : entities)
            add_elements(group, Elements(dimension, entity), nodes);
          for (auto &[type, elements] : group.elements)
            std::sort(elements.begin(), elements.end(),
                      [](const GmshMesh::Element &a, const GmshMesh::Element &b) { return a.tag < b.tag; });
          mesh.groups.push_back(std::move(group));
        }

      gmsh::vectorpair volumes;
      gmsh::model::getEntities(volumes, 3);
      for (const auto &[dimension, volume] : volumes)
        {
          std::vector<int> groups;
          gmsh::model::getPhysicalGroupsForEntity(dimension, volume, groups);
          if (groups.empty())
            for (const auto &tags : Elements(dimension, volume).tags)
              mesh.n_unnamed_volume_elements += tags.size();
        }
      return mesh;
    }
  } // namespace

  void start_gmsh()
  {
    // One of its libraries would keep preferences in the user's folder
    const char       *variable = std::getenv("HOME");
    const std::string home     = variable != nullptr ? variable : "/";
    setenv("HOME", "/nonexistent", 1);
    gmsh::initialize(0, nullptr, /* readConfigFiles */ false);
    setenv("HOME", home.c_str(), 1);
    gmsh::option::setNumber("General.Terminal", 1);
    gmsh::option::setNumber("General.NumThreads", 1);
    // An exception could not leave the parallel region in which Gmsh meshes
    // surfaces and would end the program; errors are found in the log instead.
    gmsh::option::setNumber("General.AbortOnError", 0);
    gmsh::option::setNumber("Mesh.RandomSeed", 1);
    gmsh::option::setNumber("Mesh.RandomFactor", 1e-9);
    gmsh::logger::start();
  }

  void set_number(const std::string &name, const double value)
  {
    attempt("setting a parameter of the geometry", [&] { gmsh::onelab::setNumber(name, {value}); });
  }

  GmshMesh mesh_geometry(const std::string &file)
  {
    attempt("reading the geometry", [&] { gmsh::open(file); });
    const auto groups    = physical_groups();
    const int  dimension = groups.empty() ? 0 : groups.back().first;
    if (dimension >= 2 && Elements(dimension).types.empty())
      attempt(dimension == 3 ? "meshing the solid" : "meshing the plan", [&] {
        if (dimension == 2)
          for (const char *option : {"Mesh.RecombineAll", "Mesh.RecombinationAlgorithm", "Mesh.SubdivisionAlgorithm"})
            gmsh::option::setNumber(option, 1);
        gmsh::model::mesh::generate(dimension);
      });
    GmshMesh mesh;
    attempt("handing over the mesh", [&] { mesh = collect_mesh(); });
    return mesh;
  }
} // namespace Squeal
