# SPDX-License-Identifier: GPL-3.0-or-later

import pathlib

from spack_repo.builtin.build_systems.cmake import CMakePackage, generator

from spack.package import *


class Squeal(CMakePackage):
    """Stability of disc brakes in sliding contact."""

    # The checkout with this recipe
    git = pathlib.Path(__file__).resolve().parents[5].as_uri()

    license("GPL-3.0-or-later")

    version("main", branch="main")

    variant("python", default=True, description="Libraries of the Python module, plots and imports")

    generator("ninja")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")

    depends_on("mpi")
    depends_on("blas")
    depends_on("lapack")
    requires("^[virtuals=blas,lapack] openblas", msg="squeal uses the LAPACKE of OpenBLAS")

    depends_on("dealii@9.4:+mpi+trilinos+metis+gmsh")
    depends_on("trilinos+anasazi")
    depends_on("gmsh@4.8:+opencascade")
    depends_on("suite-sparse")
    depends_on("mumps+mpi+double")
    depends_on("arpack-ng@3.6:+mpi+icb")
    depends_on("boost@1.74:+serialization+filesystem")
    depends_on("eigen@3.4:")
    depends_on("ceres-solver@2.1:")
    depends_on("glog")
    depends_on("nlopt@2.7:")
    depends_on("openturns@1.20:~python")
    depends_on("muparser")
    depends_on("nlohmann-json")
    depends_on("libseccomp")
    depends_on("zlib-api")

    with when("+python"):
        depends_on("python@3.11:", type="run")
        depends_on("py-numpy", type="run")
        depends_on("py-scipy", type="run")
        depends_on("py-matplotlib", type="run")
        depends_on("py-mpmath", type="run")
        depends_on("py-pandas", type="run")
        depends_on("py-meshio", type="run")
        depends_on("py-h5py", type="run")
        depends_on("py-netcdf4", type="run")
        depends_on("py-pyyaml", type="run")

    def cmake_args(self):
        return [self.define("SQUEAL_BUILD_TESTS", False)]
