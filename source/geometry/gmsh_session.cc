#include <squeal/geometry/gmsh_session.h>

#include <gmsh.h>

#include <algorithm>
#include <map>
#include <new>
#include <numeric>
#include <unordered_map>

namespace Squeal
{
  namespace
  {
    constexpr std::size_t n_quoted_log_lines = 8;

    std::vector<std::string> gmsh_log()
    {
      std::vector<std::string> log;
      gmsh::logger::get(log);
      return log;
    }

    bool is_error(const std::string &line)
    {
      return line.rfind("Error", 0) == 0;
    }

    /// The end of the log, from the first error if that is further up.
    std::string relevant_lines(const std::vector<std::string> &log)
    {
      std::string       quoted;
      const std::size_t end   = log.size() > n_quoted_log_lines ? log.size() - n_quoted_log_lines : 0;
      const std::size_t error = std::find_if(log.begin(), log.end(), is_error) - log.begin();
      const std::size_t first = std::min(end, error);
      for (std::size_t i = first; i < std::min(log.size(), first + n_quoted_log_lines); ++i)
        quoted += "\n    | " + log[i];
      return quoted.empty() ? "\n    | (Gmsh's log is empty)" : quoted;
    }

    /// Sorts the elements of a block by their tags: Gmsh groups them by entity.
    void sort_by_tag(GmshMesh::Block &block)
    {
      std::vector<std::size_t> order(block.tags.size());
      std::iota(order.begin(), order.end(), 0);
      std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return block.tags[a] < block.tags[b]; });

      GmshMesh::Block sorted = block;
      for (std::size_t i = 0; i < order.size(); ++i)
        {
          sorted.tags[i] = block.tags[order[i]];
          for (unsigned int v = 0; v < block.nodes_per_element; ++v)
            sorted.nodes[i * block.nodes_per_element + v] = block.nodes[order[i] * block.nodes_per_element + v];
        }
      block = std::move(sorted);
    }

    GmshMesh collect_mesh()
    {
      GmshMesh mesh;

      // Nodes, numbered in the order of their tags
      std::vector<std::size_t> tags;
      std::vector<double>      coordinates, parametric;
      gmsh::model::mesh::getNodes(tags, coordinates, parametric);
      std::vector<std::size_t> order(tags.size());
      std::iota(order.begin(), order.end(), 0);
      std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
      std::unordered_map<std::size_t, unsigned int> index;
      for (const std::size_t i : order)
        if (index.emplace(tags[i], mesh.points.size()).second)
          mesh.points.push_back({{coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]}});

      // Elements, by physical group and type
      gmsh::vectorpair groups;
      gmsh::model::getPhysicalGroups(groups);
      std::sort(groups.begin(), groups.end());
      for (const auto &[dimension, group_tag] : groups)
        {
          GmshMesh::Group group;
          group.dimension = dimension;
          gmsh::model::getPhysicalName(dimension, group_tag, group.name);

          std::map<int, GmshMesh::Block> blocks;
          std::vector<int>               entities;
          gmsh::model::getEntitiesForPhysicalGroup(dimension, group_tag, entities);
          for (const int entity : entities)
            {
              std::vector<int>                      types;
              std::vector<std::vector<std::size_t>> element_tags, element_nodes;
              gmsh::model::mesh::getElements(types, element_tags, element_nodes, dimension, entity);
              for (std::size_t t = 0; t < types.size(); ++t)
                {
                  GmshMesh::Block    &block = blocks[types[t]];
                  int                 element_dimension, element_order, n_nodes, n_primary_nodes;
                  std::vector<double> local_coordinates;
                  gmsh::model::mesh::getElementProperties(types[t], block.type, element_dimension, element_order, n_nodes,
                                                          local_coordinates, n_primary_nodes);
                  block.nodes_per_element = n_nodes;
                  block.tags.insert(block.tags.end(), element_tags[t].begin(), element_tags[t].end());
                  for (const std::size_t node : element_nodes[t])
                    block.nodes.push_back(index.at(node));
                }
            }
          for (auto &[type, block] : blocks)
            {
              sort_by_tag(block);
              group.blocks.push_back(std::move(block));
            }
          mesh.groups.push_back(std::move(group));
        }

      // Volume elements that no physical group would carry over
      mesh.n_unnamed_volume_elements = 0;
      gmsh::vectorpair volumes;
      gmsh::model::getEntities(volumes, 3);
      for (const auto &[dimension, volume] : volumes)
        {
          std::vector<int> physical_tags;
          gmsh::model::getPhysicalGroupsForEntity(dimension, volume, physical_tags);
          if (!physical_tags.empty())
            continue;
          std::vector<int>                      types;
          std::vector<std::vector<std::size_t>> element_tags, element_nodes;
          gmsh::model::mesh::getElements(types, element_tags, element_nodes, dimension, volume);
          for (const auto &tags_of_type : element_tags)
            mesh.n_unnamed_volume_elements += tags_of_type.size();
        }
      return mesh;
    }
  } // namespace

  GmshSession::GmshSession(const bool prints)
  {
    gmsh::initialize(0, nullptr, /* readConfigFiles */ false);
    gmsh::option::setNumber("General.Terminal", prints);
    gmsh::option::setNumber("General.NumThreads", 1);
    // An exception could not leave the parallel region in which Gmsh meshes
    // surfaces and would end the program; errors are found in the log instead.
    gmsh::option::setNumber("General.AbortOnError", 0);
    gmsh::option::setNumber("Mesh.RandomSeed", 1);
    gmsh::option::setNumber("Mesh.RandomFactor", 1e-9);
    gmsh::logger::start();
  }

  GmshSession::~GmshSession()
  {
    try
      {
        gmsh::logger::stop();
        gmsh::finalize();
      }
    catch (...)
      {
        // A mesh that was handed over is not lost because Gmsh ends badly.
      }
  }

  void GmshSession::run(const std::string &step, const std::function<void()> &action) const
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

    // Gmsh carries on after most errors, so a call that returns has not
    // necessarily succeeded.
    const std::vector<std::string> log = gmsh_log();
    for (const std::string &line : log)
      failed = failed || is_error(line);
    if (failed)
      throw GmshError("Gmsh failed while " + step + ". Its log:" + relevant_lines(log));
  }

  void GmshSession::set_number(const std::string &name, const double value)
  {
    run("setting a parameter of the geometry", [&] { gmsh::onelab::setNumber(name, {value}); });
  }

  void GmshSession::open(const std::string &file)
  {
    run("reading the geometry", [&] { gmsh::open(file); });
  }

  int GmshSession::dimension() const
  {
    int              dimension = 0;
    gmsh::vectorpair groups;
    gmsh::model::getPhysicalGroups(groups);
    for (const auto &group : groups)
      dimension = std::max(dimension, group.first);
    return dimension;
  }

  bool GmshSession::is_meshed(const int dimension) const
  {
    std::vector<int>                      types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, dimension);
    return !types.empty();
  }

  void GmshSession::mesh_plan()
  {
    run("meshing the plan", [] {
      gmsh::option::setNumber("Mesh.RecombineAll", 1);
      gmsh::option::setNumber("Mesh.RecombinationAlgorithm", 1);
      gmsh::option::setNumber("Mesh.SubdivisionAlgorithm", 1);
      gmsh::model::mesh::generate(2);
    });
  }

  void GmshSession::mesh_solid()
  {
    run("meshing the solid", [] { gmsh::model::mesh::generate(3); });
  }

  GmshMesh GmshSession::mesh() const
  {
    GmshMesh mesh;
    run("handing over the mesh", [&] { mesh = collect_mesh(); });
    return mesh;
  }

  void GmshSession::load(const GmshMesh &mesh)
  {
    run("taking over a mesh", [&] {
      gmsh::model::add("squeal");

      // Entities and names: one discrete entity for each group
      std::map<int, int>                    next_tag;
      std::vector<int>                      tags;
      std::vector<std::vector<std::size_t>> nodes_of_entity(mesh.groups.size());
      std::vector<std::size_t>              owner(mesh.points.size(), mesh.groups.size());
      for (const GmshMesh::Group &group : mesh.groups)
        {
          tags.push_back(++next_tag[group.dimension]);
          gmsh::model::addDiscreteEntity(group.dimension, tags.back());
          gmsh::model::addPhysicalGroup(group.dimension, {tags.back()}, tags.back());
          gmsh::model::setPhysicalName(group.dimension, tags.back(), group.name);
          if (group.dimension == 3)
            for (const GmshMesh::Block &block : group.blocks)
              for (const unsigned int node : block.nodes)
                owner[node] = tags.size() - 1;
        }

      // Nodes, on the volume they belong to
      for (std::size_t node = 0; node < owner.size(); ++node)
        if (owner[node] < nodes_of_entity.size())
          nodes_of_entity[owner[node]].push_back(node);
      for (std::size_t g = 0; g < mesh.groups.size(); ++g)
        {
          std::vector<std::size_t> node_tags;
          std::vector<double>      coordinates;
          for (const std::size_t node : nodes_of_entity[g])
            {
              node_tags.push_back(node + 1);
              coordinates.insert(coordinates.end(), mesh.points[node].begin(), mesh.points[node].end());
            }
          if (!node_tags.empty())
            gmsh::model::mesh::addNodes(mesh.groups[g].dimension, tags[g], node_tags, coordinates);
        }

      // Elements
      for (std::size_t g = 0; g < mesh.groups.size(); ++g)
        for (const GmshMesh::Block &block : mesh.groups[g].blocks)
          {
            std::vector<std::size_t> node_tags(block.nodes.begin(), block.nodes.end());
            for (std::size_t &node : node_tags)
              ++node;
            gmsh::model::mesh::addElementsByType(tags[g], block.nodes_per_element == 8 ? 5 : 3, block.tags, node_tags);
          }
    });
  }

  void GmshSession::write(const std::string &file)
  {
    run("writing the mesh", [&] {
      gmsh::option::setNumber("Mesh.MshFileVersion", 4.1);
      gmsh::option::setNumber("Mesh.Binary", 0);
      gmsh::write(file);
    });
  }
} // namespace Squeal
