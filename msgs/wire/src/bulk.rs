//! Bulk arrays: many small plain values, encoded as their bytes, so that a million points cost one memcpy.

use crate::{Layout, fold, fold_str};
use bincode::de::{Decode, Decoder, read::Reader};
use bincode::enc::{Encode, Encoder, write::Writer};
use bincode::error::{DecodeError, EncodeError};
use bytemuck::Pod;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::{Deref, DerefMut};

/// An array of plain values that travels as little-endian bytes behind its length.
#[derive(Clone, PartialEq)]
pub struct Bulk<T>(pub Vec<T>);

/// Hostile lengths must not allocate: bytes are taken in steps of this size, each only when the one before was there.
const STEP_BYTES: usize = 1 << 20;

impl<T> Default for Bulk<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}
impl<T> From<Vec<T>> for Bulk<T> {
    fn from(values: Vec<T>) -> Self {
        Self(values)
    }
}
impl<T> FromIterator<T> for Bulk<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Self(values.into_iter().collect())
    }
}
impl<T> Deref for Bulk<T> {
    type Target = Vec<T>;
    fn deref(&self) -> &Vec<T> {
        &self.0
    }
}
impl<T> DerefMut for Bulk<T> {
    fn deref_mut(&mut self) -> &mut Vec<T> {
        &mut self.0
    }
}
impl<T: fmt::Debug> fmt::Debug for Bulk<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SHOWN: usize = 3;
        write!(f, "{} x ", self.0.len())?;
        f.debug_list().entries(self.0.iter().take(SHOWN)).finish()
    }
}

impl<T: Layout> Layout for Bulk<T> {
    const HASH: u64 = fold(fold_str(0xcbf2_9ce4_8422_2325, "Bulk"), T::HASH);
    fn describe(known: &mut BTreeMap<String, String>) -> String {
        format!("Bulk<{}>", T::describe(known))
    }
}

impl<T: Pod> Encode for Bulk<T> {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        (self.0.len() as u64).encode(encoder)?;
        encoder.writer().write(bytemuck::cast_slice(&self.0))
    }
}

impl<T: Pod, C> Decode<C> for Bulk<T> {
    fn decode<D: Decoder<Context = C>>(decoder: &mut D) -> Result<Self, DecodeError> {
        let len = usize::try_from(u64::decode(decoder)?).map_err(|_| DecodeError::LimitExceeded)?;
        let total = len.checked_mul(size_of::<T>()).ok_or(DecodeError::LimitExceeded)?;
        decoder.claim_bytes_read(total)?;
        let per_step = (STEP_BYTES / size_of::<T>()).max(1);
        let mut values: Vec<T> = Vec::new();
        while values.len() < len {
            let start = values.len();
            let count = per_step.min(len - start);
            // Doubling as it grows keeps a large array at an amortised single copy.
            values.resize(start + count, T::zeroed());
            decoder.reader().read(bytemuck::cast_slice_mut(&mut values[start..]))?;
        }
        Ok(Self(values))
    }
}

impl<'de, T: Pod, C> bincode::de::BorrowDecode<'de, C> for Bulk<T> {
    fn borrow_decode<D: bincode::de::BorrowDecoder<'de, Context = C>>(decoder: &mut D) -> Result<Self, DecodeError> {
        Self::decode(decoder)
    }
}
