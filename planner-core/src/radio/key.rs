//! The secret that signs frames.

/// A secret that a fleet shares, with which frames are signed (SipHash-2-4,
/// the first 32 bits).
#[cfg(feature = "keyed")]
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Key(pub [u8; 16]);

/// No frame is signed without the feature `keyed`.
#[cfg(not(feature = "keyed"))]
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Key {}

impl Key {
    #[cfg(feature = "keyed")]
    pub(crate) fn tag(&self, bytes: &[u8]) -> [u8; 4] {
        use core::hash::Hasher;
        let mut hasher = siphasher::sip::SipHasher24::new_with_key(&self.0);
        hasher.write(bytes);
        let [a, b, c, d, ..] = hasher.finish().to_le_bytes();
        [a, b, c, d]
    }

    /// Whether `tag` is that of `bytes`, in a time that does not hang on how much of it
    /// is.
    #[cfg(feature = "keyed")]
    pub(crate) fn verifies(&self, bytes: &[u8], tag: &[u8]) -> bool {
        use subtle::ConstantTimeEq;
        self.tag(bytes).ct_eq(tag).into()
    }

    #[cfg(not(feature = "keyed"))]
    pub(crate) fn tag(&self, _: &[u8]) -> [u8; 4] {
        match *self {}
    }

    #[cfg(not(feature = "keyed"))]
    pub(crate) fn verifies(&self, _: &[u8], _: &[u8]) -> bool {
        match *self {}
    }
}

/// Never shows the secret.
impl core::fmt::Debug for Key {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Key(…)")
    }
}
