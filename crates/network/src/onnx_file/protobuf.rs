/// The fields of one protobuf message, in the order in which they stand.
///
/// Source: "Encoding", Protocol Buffers documentation, protobuf.dev/programming-guides/encoding.
#[derive(Clone)]
pub(crate) struct Fields<'a> {
    bytes: &'a [u8],
    /// Where `bytes` begins in the file.
    offset: usize,
}

/// One field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Field<'a> {
    pub(crate) number: u64,
    pub(crate) value: Value<'a>,
    /// Where its value begins in the file.
    pub(crate) offset: usize,
    /// All of it, the key included.
    pub(crate) raw: &'a [u8],
}

/// What a field holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value<'a> {
    /// A whole number.
    Number(u64),
    /// Eight or four bytes of a number that nothing here needs.
    Fixed,
    /// Text, numbers packed together, or another message.
    Bytes(&'a [u8]),
}

/// Where and why a message cannot be read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Damage {
    /// It ends within the field at this place of the file.
    Short(usize),
    /// What stands there is no field.
    Foreign(usize),
}

impl<'a> Fields<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, offset: 0 }
    }

    /// The first `count` bytes.
    fn take(&mut self, count: u64) -> Result<&'a [u8], Damage> {
        let taken = usize::try_from(count)
            .ok()
            .and_then(|count| self.bytes.split_at_checked(count));
        let (head, tail) = taken.ok_or(Damage::Short(self.offset))?;
        self.bytes = tail;
        self.offset += head.len();
        Ok(head)
    }

    /// A number, seven bits to the byte, the lowest first.
    fn number(&mut self) -> Result<u64, Damage> {
        let start = self.offset;
        let mut number = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.take(1)?[0];
            number |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Ok(number);
            }
        }
        Err(Damage::Foreign(start))
    }

    fn field(&mut self) -> Result<Field<'a>, Damage> {
        let (start, bytes) = (self.offset, self.bytes);
        let key = self.number()?;
        let value_of = |fields: &mut Self| match key & 7 {
            0 => fields.number().map(Value::Number),
            1 => fields.take(8).map(|_| Value::Fixed),
            2 => {
                let length = fields.number()?;
                fields.take(length).map(Value::Bytes)
            }
            5 => fields.take(4).map(|_| Value::Fixed),
            _ => Err(Damage::Foreign(start)),
        };
        let number = key >> 3;
        if number == 0 {
            return Err(Damage::Foreign(start));
        }
        let value = value_of(self)?;
        let length = if let Value::Bytes(bytes) = value {
            bytes.len()
        } else {
            0
        };
        Ok(Field {
            number,
            value,
            offset: self.offset - length,
            raw: &bytes[..self.offset - start],
        })
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = Result<Field<'a>, Damage>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.bytes.is_empty() {
            return None;
        }
        let field = self.field();
        if field.is_err() {
            self.bytes = &[];
        }
        Some(field)
    }
}

impl<'a> Field<'a> {
    /// The fields of the message that it holds.
    pub(crate) fn message(&self) -> Result<Fields<'a>, Damage> {
        Ok(Fields {
            bytes: self.bytes()?,
            offset: self.offset,
        })
    }

    /// The text that it holds; what is no UTF-8 shows as such.
    pub(crate) fn text(&self) -> Result<String, Damage> {
        Ok(String::from_utf8_lossy(self.bytes()?).into_owned())
    }

    /// Its bytes.
    pub(crate) fn bytes(&self) -> Result<&'a [u8], Damage> {
        match self.value {
            Value::Bytes(bytes) => Ok(bytes),
            _ => Err(Damage::Foreign(self.offset)),
        }
    }

    /// Its number; negative ones as two's complement.
    pub(crate) fn number_value(&self) -> Result<i64, Damage> {
        match self.value {
            Value::Number(number) => Ok(number.cast_signed()),
            _ => Err(Damage::Foreign(self.offset)),
        }
    }

    /// Its numbers: one, or many packed together.
    pub(crate) fn numbers(&self) -> Result<Vec<i64>, Damage> {
        if let Value::Number(number) = self.value {
            return Ok(vec![number.cast_signed()]);
        }
        let mut packed = self.message()?;
        let mut numbers = Vec::new();
        while !packed.bytes.is_empty() {
            numbers.push(packed.number()?.cast_signed());
        }
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_documentations_own_example() {
        let fields: Vec<_> = Fields::new(&[0x08, 0x96, 0x01, 0x12, 0x02, b'h', b'i'])
            .map(Result::unwrap)
            .collect();
        assert_eq!((fields[0].number, fields[0].number_value()), (1, Ok(150)));
        assert_eq!((fields[1].number, fields[1].text()), (2, Ok("hi".into())));
        assert_eq!(fields[1].offset, 5);
    }

    #[test]
    fn packed_numbers() {
        let field = Fields::new(&[0x0a, 0x03, 0x01, 0x96, 0x01])
            .next()
            .unwrap()
            .unwrap();
        assert_eq!(field.numbers(), Ok(vec![1, 150]));
    }

    #[test]
    fn damage_has_a_place() {
        fn last(bytes: &[u8]) -> Result<Field<'_>, Damage> {
            Fields::new(bytes).last().unwrap()
        }
        assert_eq!(last(&[0x08, 0x01, 0x12, 0x05, b'h']), Err(Damage::Short(4)));
        assert_eq!(last(&[0x08, 0x01, 0x0b]), Err(Damage::Foreign(2)));
        assert_eq!(last(&[0x08, 0x01, 0x80]), Err(Damage::Short(3)));
        assert_eq!(last(&[0xff; 12]), Err(Damage::Foreign(0)));
    }

    proptest! {
        #[test]
        fn nothing_panics_and_all_ends(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
            for field in Fields::new(&bytes).flatten() {
                let _ = (field.numbers(), field.text());
                prop_assert!(field.offset <= bytes.len());
            }
        }
    }
}
