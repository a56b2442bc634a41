#pragma once

#include <squeal/output/field_mesh.h>
#include <squeal/output/fields.h>

#include <map>

namespace Squeal
{
  /**
   * Writes fields as XDMF, which describes what the files of HDF5 beside it hold. All processes must call.
   *
   * Meshes are written once, with shared vertices: `modes/mesh.h5` has the bodies and the contact faces, `modes/mesh_disc.h5` and
   * `modes/mesh_pins.h5` one component each. A mode is `modes/NAME.h5` with the fields, in single precision and compressed, described by
   * `modes/NAME.xdmf`, and by `modes/NAME_contact.xdmf` for the contact faces. Lists, which come in such pairs too, and animations are
   * `NAME.xdmf` that refer to the same files, and to `animations/NAME.h5`. The amplitude is the root of the sum of |u|² over the
   * components. The title of a mode is the name of its grid, and the attribute `mode` of its file.
   */
  class XdmfWriter : public ModeFieldWriter
  {
  public:
    /// @param closed numbers of the pairs that are in contact, among those of @p interface
    XdmfWriter(const Model &model, const ContactInterface &interface, const std::vector<unsigned int> &closed, const ResultFolder &folder);

    void write_mode(const ModeField &mode) override;

    void write_mode(const RealModeField &mode) override;

    void write_list(const std::string &name, const std::vector<ListedMode> &modes) override;

    void write_animation(const ModeField &mode, const AnimationOptions &options) override;

    /// A field in a file of HDF5, which is seen from the result folder, as all files here.
    struct Field
    {
      std::string  name, file, dataset;
      unsigned int n_columns;
    };

    /// Cells with fields.
    struct Grid
    {
      std::string        title;
      std::string        mesh_file; ///< of HDF5
      std::string        group;     ///< of that file
      const FieldMesh   *mesh;
      std::vector<Field> fields;
    };

    /// A mode that has been written.
    struct Shape
    {
      Grid                bodies;
      std::optional<Grid> contact_faces;
    };

  private:
    /// The mesh of all bodies or of a component; what it has not written yet, it writes.
    const FieldMesh &bodies(const std::optional<Component> &component);

    /// Writes the description of a mode, and keeps it for lists.
    void keep(const std::string &name, const Shape &shape);

    const Model                                  &model;
    const ResultFolder                           &folder;
    const FieldMesh                               contact_faces;
    std::vector<float>                            closed; ///< 1 for pairs in contact
    std::map<std::optional<Component>, FieldMesh> meshes;
    std::map<std::string, Shape>                  written; ///< modes by their names
  };
} // namespace Squeal
