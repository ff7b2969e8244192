//! HDF5, and MATLAB's files of version 7.3.

mod expected;

#[test]
fn datasets_are_what_h5py_wrote() {
    expected::hold("hdf5");
}
