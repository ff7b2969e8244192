//! NumPy's arrays and archives.

mod expected;

#[test]
fn arrays_are_what_numpy_wrote() {
    expected::hold("numpy");
}
