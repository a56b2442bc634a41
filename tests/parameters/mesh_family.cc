#include "geometry/scenes.h"

#include <squeal/parameters/geometry.h>

using namespace Scenes;

TEST(MeshFamily, ScalesElementsLayersAndPinFaces)
{
  const GeometryParameters geometry; // 19 nodes, k = 2; 4 and 3 layers; 11.5 mm
  const auto               expect = [&](const double factor, const double size, const unsigned int nodes, const unsigned int of_pin,
                          const unsigned int of_disc) {
    const GeometryParameters result = refined(geometry, factor);
    EXPECT_NEAR(result.element_size, size, 1e-15) << factor;
    EXPECT_EQ(result.nodes_per_pin_face, nodes) << factor;
    EXPECT_EQ(result.pin_layers, of_pin) << factor;
    EXPECT_EQ(result.disc_layers, of_disc) << factor;
    result.check();
  };
  expect(1., 0.0115, 19, 4, 3);
  expect(2., 0.00575, 61, 8, 6);
  expect(1.5, 0.0115 / 1.5, 37, 6, 5);
  expect(0.5, 0.023, 7, 2, 2);
  expect(0.2, 0.0575, 7, 1, 1);
}

TEST(MeshFamily, KeepsTheBodies)
{
  // Smooth outlines by polygons: the volume differs by those alone
  const HexMesh coarse = generate_mesh(one_pin()), fine = generate_mesh(refined(one_pin(), 2.));
  EXPECT_EQ(coarse.volume_names, fine.volume_names);
  EXPECT_GT(fine.hexahedra.size(), 6 * coarse.hexahedra.size());
  EXPECT_LT(fine.hexahedra.size(), 10 * coarse.hexahedra.size());
  EXPECT_NEAR(volume(fine, "disc") / volume(coarse, "disc"), 1., 0.02);
}

TEST(MeshFamily, RefusesMeshesThatDoNotFollow)
{
  const File         mesh("bodies.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"disc\"\n$EndPhysicalNames\n");
  const File         solid("bodies.geo", "Box(1) = {0, 0, 0, 1, 1, 1};\nPhysical Volume(\"disc\") = {1};\n");
  GeometryParameters geometry;
  for (const File *file : {&mesh, &solid})
    {
      geometry.file = file->string();
      expect_mentions(message<ParameterError>([&] { refined(geometry, 2.); }),
                      {file->string(), "cannot be refined", "Geometry/Element size", "element_size"});
      EXPECT_EQ(refined(geometry, 1.).element_size, geometry.element_size);
    }
  geometry.file = "missing.geo";
  EXPECT_THROW(refined(geometry, 2.), MeshError);
}
