//! Files: meshes, clouds and scan folders, read and written
