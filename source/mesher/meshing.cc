// SPDX-License-Identifier: GPL-3.0-or-later

#include "meshing.h"

#include <gmsh.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <new>
#include <set>

namespace Squeal
{
  namespace
  {
    /// Runs one step and checks the log, because Gmsh continues after most errors.
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
      catch (...) // Gmsh 4.8 throws integers or strings
        {
          failed = true;
        }
      std::vector<std::string> log;
      gmsh::logger::get(log);
      if (failed || std::any_of(log.begin(), log.end(), [](const std::string &line) { return line.rfind("Error", 0) == 0; }))
        throw GmshError("Gmsh failed while " + step);
    }

    struct Elements
    {
      /// Elements of one entity, or of all entities of a dimension.
      explicit Elements(const int dimension, const int entity = -1)
      {
        gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
      }

      std::vector<int>                      types;
      std::vector<std::vector<std::size_t>> tags, nodes;
    };

    /// Physical groups as pairs of dimension and tag, ascending.
    gmsh::vectorpair physical_groups()
    {
      gmsh::vectorpair groups;
      gmsh::model::getPhysicalGroups(groups);
      std::sort(groups.begin(), groups.end());
      return groups;
    }

    /// True for mesh formats 1 and 2, in which every element has a physical tag in addition to the tag of its entity. Gmsh adds all
    /// elements of an entity to the groups of all its elements, which is wrong for files with a single entity from some converters.
    bool has_physical_tags(const std::string &file)
    {
      std::ifstream stream(file, std::ios::binary);
      std::string   word;
      double        version = 1.;
      return stream >> word && (word == "$NOD" || (word == "$MeshFormat" && stream >> version && version < 3.));
    }

    /// Collects the nodes; returns the index of each node by its tag.
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

    /// Rejects tags for which Gmsh would return the elements of all entities.
    void check_physical_tags()
    {
      gmsh::vectorpair entities;
      gmsh::model::getEntities(entities);
      for (const auto &[dimension, tag] : entities)
        if (tag < 0)
          throw GmshError("Elements of dimension " + std::to_string(dimension) + " have the negative physical tag " + std::to_string(tag));
    }

    /// Entities of a dimension by the number of their physical group; 0: no group. @p are_tagged: see has_physical_tags().
    std::map<int, std::vector<int>> physical_groups(const int dimension, const bool are_tagged)
    {
      gmsh::vectorpair entities;
      gmsh::model::getEntities(entities, dimension);
      std::map<int, std::vector<int>> result;
      for (const auto &[d, entity] : entities)
        {
          std::vector<int> groups = {entity}; // Mesh.SwitchElementTags reads physical tags as entity tags
          if (!are_tagged)
            gmsh::model::getPhysicalGroupsForEntity(dimension, entity, groups);
          if (groups.empty())
            groups = {0};
          for (const int group : groups)
            result[std::abs(group)].push_back(entity); // group numbers are negative if a file reverses the entity
        }
      return result;
    }

    /// Removes duplicate elements, which occur if an element is in two groups with the same name.
    void remove_copies(std::vector<GmshMesh::Element> &elements)
    {
      std::set<std::vector<unsigned int>> known;
      const auto                          is_copy = [&](const GmshMesh::Element &element) {
        std::vector<unsigned int> nodes = element.nodes;
        std::sort(nodes.begin(), nodes.end());
        return !known.insert(nodes).second;
      };
      elements.erase(std::remove_if(elements.begin(), elements.end(), is_copy), elements.end());
    }

    /// Physical groups of one dimension; groups with the same name are merged.
    std::vector<GmshMesh::Group> collect_groups(const int                                  dimension,
                                                const std::map<int, std::vector<int>>     &entities_of_groups,
                                                const std::map<std::size_t, unsigned int> &nodes)
    {
      std::vector<GmshMesh::Group> result;
      std::set<std::string>        shared_names;
      for (const auto &[number, entities] : entities_of_groups)
        if (number != 0)
          {
            std::string name;
            gmsh::model::getPhysicalName(dimension, number, name);
            auto group = std::find_if(result.begin(), result.end(), [&](const auto &other) { return !name.empty() && other.name == name; });
            if (group != result.end())
              shared_names.insert(name);
            else
              group = result.insert(result.end(), {dimension, number, name, {}});
            for (const int entity : entities)
              add_elements(*group, Elements(dimension, entity), nodes);
          }
      for (GmshMesh::Group &group : result)
        for (auto &[type, elements] : group.elements)
          {
            std::stable_sort(elements.begin(), elements.end(),
                             [](const GmshMesh::Element &a, const GmshMesh::Element &b) { return a.tag < b.tag; });
            if (shared_names.count(group.name) > 0)
              remove_copies(elements);
          }
      return result;
    }

    GmshMesh collect_mesh(const bool are_tagged)
    {
      GmshMesh   mesh;
      const auto nodes = collect_nodes(mesh);
      for (int dimension = 0; dimension <= 3; ++dimension)
        {
          const auto entities = physical_groups(dimension, are_tagged);
          const auto groups   = collect_groups(dimension, entities, nodes);
          mesh.groups.insert(mesh.groups.end(), groups.begin(), groups.end());
          if (const auto without = entities.find(0); dimension == 3 && without != entities.end())
            for (const int volume : without->second)
              for (const auto &tags : Elements(dimension, volume).tags)
                mesh.n_unnamed_volume_elements += tags.size();
        }
      return mesh;
    }
  } // namespace

  void start_gmsh()
  {
    // Prevent one of Gmsh's libraries from storing preferences in the user's home folder
    const char       *variable = std::getenv("HOME");
    const std::string home     = variable != nullptr ? variable : "/";
    setenv("HOME", "/dev/null", 1); // not even root can create a folder there
    gmsh::initialize(0, nullptr, /* readConfigFiles */ false);
    setenv("HOME", home.c_str(), 1);
    gmsh::option::setNumber("General.Terminal", 1);
    gmsh::option::setNumber("General.NumThreads", 1);
    // Detect errors in the log instead, because an exception in the parallel region in which Gmsh meshes surfaces would end the program
    gmsh::option::setNumber("General.AbortOnError", 0);
    gmsh::option::setNumber("Mesh.RandomSeed", 1);
    gmsh::option::setNumber("Mesh.RandomFactor", 1e-9);
    gmsh::logger::start();
  }

  void set_number(const std::string &name, const double value)
  {
    attempt("setting a parameter of the geometry", [&] { gmsh::onelab::setNumber(name, {value}); });
  }

  GmshMesh mesh_geometry(const std::string &script, const std::string &file)
  {
    const bool are_tagged = has_physical_tags(file);
    gmsh::option::setNumber("Mesh.SwitchElementTags", are_tagged);
    attempt("reading the geometry", [&] {
      gmsh::open(script);
      if (!file.empty())
        gmsh::merge(file); // instead of Include in the script, which does not accept paths with quotes
    });
    if (are_tagged)
      check_physical_tags();
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
    attempt("transferring the mesh", [&] { mesh = collect_mesh(are_tagged); });
    return mesh;
  }
} // namespace Squeal
