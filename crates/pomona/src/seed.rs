use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;

/// The generator of one apple, keyed by (run seed, frame id, apple id), so that neither the
/// other apples of the frame nor the order of work touch its numbers.
pub(crate) fn apple_rng(run_seed: u64, frame_id: &str, apple_id: usize) -> ChaCha8Rng {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&run_seed.to_le_bytes());
    key[8..16].copy_from_slice(&fnv1a(frame_id.as_bytes()).to_le_bytes());
    key[16..24].copy_from_slice(&(apple_id as u64).to_le_bytes());
    ChaCha8Rng::from_seed(key)
}

/// FNV-1a, 64 bit (Fowler, Noll and Vo; RFC 9923): a hash that is the same on every machine and build.
fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_core::Rng;

    #[test]
    fn published_hashes() {
        assert_eq!(fnv1a(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv1a(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv1a(b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn every_part_of_the_key_counts() {
        let first = |seed, frame, apple| apple_rng(seed, frame, apple).next_u64();
        let base = first(1, "a", 2);
        assert_eq!(base, first(1, "a", 2));
        assert!(
            [first(2, "a", 2), first(1, "b", 2), first(1, "a", 3)]
                .iter()
                .all(|&n| n != base)
        );
    }
}
