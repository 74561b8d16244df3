//! A hash of a message's layout, computed at compile time.
//!
//! bincode does not describe itself: a reader with another layout may decode garbage without an error. So name, version
//! and this hash travel beside the bytes, and are compared before anything is decoded. The same fields can be told in words,
//! so that a recording can still be understood when this program is gone.

use std::collections::BTreeMap;

/// What has a layout that two machines must agree on.
pub trait Layout {
    /// FNV-1a over the names and layouts of the fields.
    const HASH: u64;
    /// The name of the type; the types that it is made of are put into `known`, each as its source spells it.
    fn describe(known: &mut BTreeMap<String, String>) -> String;
}

/// What is sent on its own: a named, versioned layout that begins with a header.
pub trait Message: Layout + bincode::Encode + bincode::Decode<()> + Clone + Send + 'static {
    /// The name of the struct.
    const NAME: &'static str;
    /// Raised when the meaning of a field changes; a change of layout shows in the hash by itself.
    const VERSION: u32;
    /// The header of this message.
    fn header(&self) -> &crate::Header;
    /// The header, to be stamped by the publisher.
    fn header_mut(&mut self) -> &mut crate::Header;
    /// Takes out the bytes that its encoding ends with, when they are its last field and many: a picture's pixels. They
    /// travel as they lie in memory, so whoever sends them need not copy them.
    fn take_tail(&mut self) -> Vec<u8> {
        Vec::new()
    }
}

const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x0000_0100_0000_01b3;

/// Folds eight more bytes into a hash.
pub const fn fold(hash: u64, value: u64) -> u64 {
    let bytes = value.to_le_bytes();
    let mut h = hash;
    let mut i = 0;
    while i < bytes.len() {
        h = (h ^ bytes[i] as u64).wrapping_mul(FNV_PRIME);
        i += 1;
    }
    h
}

/// Folds a name into a hash.
pub const fn fold_str(hash: u64, text: &str) -> u64 {
    let bytes = text.as_bytes();
    let mut h = hash;
    let mut i = 0;
    while i < bytes.len() {
        h = (h ^ bytes[i] as u64).wrapping_mul(FNV_PRIME);
        i += 1;
    }
    fold(h, bytes.len() as u64)
}

const fn of(name: &str) -> u64 {
    fold_str(FNV_OFFSET, name)
}

macro_rules! primitives {
    ($($t:ty),*) => { $(impl Layout for $t {
        const HASH: u64 = of(stringify!($t));
        fn describe(_known: &mut BTreeMap<String, String>) -> String {
            stringify!($t).to_owned()
        }
    })* };
}
primitives!(bool, u8, u16, u32, u64, i32, i64, f32, f64, String);

impl<T: Layout> Layout for Vec<T> {
    const HASH: u64 = fold(of("Vec"), T::HASH);
    fn describe(known: &mut BTreeMap<String, String>) -> String {
        format!("Vec<{}>", T::describe(known))
    }
}
impl<T: Layout> Layout for Option<T> {
    const HASH: u64 = fold(of("Option"), T::HASH);
    fn describe(known: &mut BTreeMap<String, String>) -> String {
        format!("Option<{}>", T::describe(known))
    }
}
impl<T: Layout, const N: usize> Layout for [T; N] {
    const HASH: u64 = fold(fold(of("array"), T::HASH), N as u64);
    fn describe(known: &mut BTreeMap<String, String>) -> String {
        format!("[{}; {N}]", T::describe(known))
    }
}

/// Notes the definition of a type and returns its name.
pub(crate) fn define(known: &mut BTreeMap<String, String>, kind: &str, name: &str, lines: &[String]) -> String {
    let body: String = lines.iter().map(|line| format!("    {line},\n")).collect();
    known.insert(name.to_owned(), format!("{kind} {name} {{\n{body}}}\n"));
    name.to_owned()
}

/// Declares a struct of plain fields together with its layout hash.
macro_rules! layout {
    ($(#[$meta:meta])* pub struct $name:ident { $($(#[$field_meta:meta])* pub $field:ident: $t:ty,)* }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, PartialEq, bincode::Encode, bincode::Decode)]
        pub struct $name { $($(#[$field_meta])* pub $field: $t,)* }
        impl $crate::Layout for $name {
            const HASH: u64 = {
                #[allow(unused_mut)]
                let mut h = $crate::fold_str(0xcbf2_9ce4_8422_2325, stringify!($name));
                $(h = $crate::fold($crate::fold_str(h, stringify!($field)), <$t as $crate::Layout>::HASH);)*
                h
            };
            fn describe(known: &mut std::collections::BTreeMap<String, String>) -> String {
                let fields = [$((stringify!($field), <$t as $crate::Layout>::describe(known))),*];
                $crate::layout::define(known, "struct", stringify!($name), fields.map(|(name, of)| format!("{name}: {of}")).as_slice())
            }
        }
    };
    ($(#[$meta:meta])* pub enum $name:ident { $($(#[$v_meta:meta])* $variant:ident,)* }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, bincode::Encode, bincode::Decode)]
        pub enum $name { $($(#[$v_meta])* $variant,)* }
        impl $crate::Layout for $name {
            const HASH: u64 = {
                let mut h = $crate::fold_str(0xcbf2_9ce4_8422_2325, stringify!($name));
                $(h = $crate::fold_str(h, stringify!($variant));)*
                h
            };
            fn describe(known: &mut std::collections::BTreeMap<String, String>) -> String {
                let variants = [$(stringify!($variant).to_owned()),*];
                $crate::layout::define(known, "enum", stringify!($name), variants.as_slice())
            }
        }
    };
}

/// Declares an element of a [`crate::Bulk`] array: plain old data, copied as bytes.
macro_rules! element {
    ($(#[$meta:meta])* pub struct $name:ident { $($(#[$field_meta:meta])* pub $field:ident: $t:ty,)* }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Default, bytemuck::Pod, bytemuck::Zeroable)]
        #[repr(C)]
        pub struct $name { $($(#[$field_meta])* pub $field: $t,)* }
        impl $crate::Layout for $name {
            const HASH: u64 = {
                let mut h = $crate::fold_str(0xcbf2_9ce4_8422_2325, stringify!($name));
                $(h = $crate::fold($crate::fold_str(h, stringify!($field)), <$t as $crate::Layout>::HASH);)*
                h
            };
            fn describe(known: &mut std::collections::BTreeMap<String, String>) -> String {
                let fields = [$((stringify!($field), <$t as $crate::Layout>::describe(known))),*];
                $crate::layout::define(known, "struct", stringify!($name), fields.map(|(name, of)| format!("{name}: {of}")).as_slice())
            }
        }
    };
}

/// Makes a declared struct a message: `message!(Pose @ 1);`, and with bytes as its last field `message!(Frame @ 1, data);`
macro_rules! message {
    ($name:ident @ $version:literal $(, $tail:ident)?) => {
        impl $crate::Message for $name {
            const NAME: &'static str = stringify!($name);
            const VERSION: u32 = $version;
            fn header(&self) -> &$crate::Header {
                &self.header
            }
            fn header_mut(&mut self) -> &mut $crate::Header {
                &mut self.header
            }
            $(fn take_tail(&mut self) -> Vec<u8> {
                std::mem::take(&mut self.$tail.0)
            })?
        }
    };
}

pub(crate) use {element, layout, message};
